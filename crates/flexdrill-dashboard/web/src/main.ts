// The rig-side page: one store, views that read it, one picture loop.

import "uplot/dist/uPlot.min.css";
import "./page.css";
import * as api from "./api";
import { Binding } from "./binding";
import { h } from "./dom";
import { Inbox } from "./store/inbox";
import { Store } from "./store/store";
import { EVERY } from "./store/topics";
import { Context, type View } from "./view";
import { HeatMap } from "./views/heatmap";
import { Numbers } from "./views/numbers";
import { Panels } from "./views/panels";
import { Scene } from "./views/scene";
import { StateLine } from "./views/state";
import { Steer } from "./views/steer";
import { TimeLine } from "./views/timeline";
import { Wall } from "./views/wall";

const store = new Store();
const context = new Context(store);
const inbox = new Inbox(EVERY, ({ topic, schema, time, data }) => store.take(topic, schema, time, data));
api.token();

const scene = new Scene(context);
const maps = [
  new HeatMap(context, "Pipe on guide", "pipe_guide_normal_peak"),
  new HeatMap(context, "Guide on wall", "guide_wall_normal_peak"),
];
const state = new StateLine(context);
const numbers = new Numbers(context);
const panels = new Panels(context, new Steer(context));
const time = new TimeLine(context);
const wall = new Wall(context, numbers);
const views: View[] = [state, numbers, scene, ...maps, panels, time, wall];

document
  .getElementById("root")
  ?.append(
    state.element,
    h(
      "main",
      {},
      numbers.element,
      h("div", { class: "centre" }, scene.element, h("div", { class: "maps" }, ...maps.map((map) => map.element))),
      panels.element,
    ),
    wall.element,
    time.element,
  );

const binding = new Binding(store, inbox);
store.connection = binding.connection;

const frame = (now: number) => {
  for (const view of views) view.draw(now);
  requestAnimationFrame(frame);
};
requestAnimationFrame(frame);

// For measurements and tests: pictures of the scene drawn so far, and what the page knows.
Object.assign(window, { flexdrill: { store, context, scene, inbox } });
