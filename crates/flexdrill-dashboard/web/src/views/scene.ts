// The tool in its well, turned and zoomed by hand, finger and keys.

import { fit, h, setText, show } from "../dom";
import { Camera, project, type Vec3 } from "../scene/matrix";
import { Renderer } from "../scene/renderer";
import { ruler, type Ruler } from "../scene/ruler";
import { ToolMeshes } from "../scene/tool";
import { channels } from "../theme";
import { clock, convert, lapse, number, withUnit } from "../units";
import { PRIORITY_SHAPE } from "../words";
import type { Context, View } from "../view";

/** Points of the picture per point of the screen: at most, and while the processor has to turn the tool. */
const FINE = 1.5;
const COARSE = 0.66;
/** Time without a movement after which the tool is drawn finely again (ms). */
const AT_REST = 200;
/** A page that does not keep up draws for at most this part of its time. */
const SHARE = 0.3;
/** Room to the left of the scale of depth that its title takes (pixels). */
const TITLE = 110;
/** How near a click must be to a station (pixels). */
const REACH = 30;

export class Scene implements View {
  readonly element: HTMLElement;
  /** Pictures drawn since the page was opened. */
  pictures = 0;
  private readonly canvas = h("canvas", {
    id: "scene",
    tabindex: "0",
    role: "img",
    "aria-label":
      "The tool in its well. Arrow keys turn it, plus and minus zoom, brackets go from joint to joint, F shows all.",
  });
  private readonly overlay = h("div", { class: "overlay", "aria-hidden": "true" });
  private readonly lines = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  private readonly legend = h("p", { class: "legend" });
  private readonly past = h("p", { class: "past-mark" });
  private readonly trouble = h("p", { class: "trouble" });
  private readonly camera = new Camera();
  private readonly meshes = new ToolMeshes();
  private renderer: Renderer | null = null;
  private drawnKey = "";
  private framed = "";
  private moved = true;
  private movedAt = -Infinity;
  private matrix: Float32Array<ArrayBufferLike> = new Float32Array(16);
  private readonly pointers = new Map<number, { x: number; y: number }>();
  private travelled = 0;
  private ruler: Ruler | null = null;
  /** No picture before this (ms). */
  private rest = -Infinity;

  constructor(private readonly context: Context) {
    const output = h("output", {}, `×${context.settings.exaggeration}`);
    const slider = h("input", {
      type: "range",
      id: "exaggeration",
      min: "1",
      max: "30",
      step: "1",
      value: String(context.settings.exaggeration),
      oninput: () => {
        setText(output, `×${slider.value}`);
        context.change({ exaggeration: Number(slider.value) });
      },
    });
    const all = h("button", { type: "button", onclick: () => this.frame() }, "show all");
    this.element = h(
      "section",
      { class: "scene", "aria-label": "Tool in its well" },
      this.canvas,
      this.lines,
      this.overlay,
      this.trouble,
      this.past,
      h("div", { class: "scene-tools" }, h("label", {}, "clearances ", slider, output), all),
      this.legend,
    );
    this.lines.setAttribute("class", "lines");
    this.lines.setAttribute("aria-hidden", "true");
    try {
      this.renderer = new Renderer(this.canvas);
    } catch (error) {
      setText(this.trouble, `No picture of the tool: ${(error as Error).message}. All other views work.`);
    }
    this.canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      this.renderer = null;
    });
    this.canvas.addEventListener("webglcontextrestored", () => {
      this.renderer = new Renderer(this.canvas);
      this.drawnKey = "";
    });
    this.listen();
  }

  private listen(): void {
    const { canvas, camera } = this;
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
      if (this.pointers.size === 1) this.travelled = 0;
    });
    canvas.addEventListener("pointermove", (event) => {
      const last = this.pointers.get(event.pointerId);
      if (!last) return;
      const [dx, dy] = [event.offsetX - last.x, event.offsetY - last.y];
      this.travelled += Math.abs(dx) + Math.abs(dy);
      if (this.pointers.size === 1) {
        if (event.shiftKey || (event.buttons & 6) !== 0) camera.pan(dx / canvas.clientHeight, dy / canvas.clientHeight);
        else camera.turn(-dx * 0.006, dy * 0.006);
      } else {
        // Two fingers: their distance zooms, their middle moves.
        const [other] = [...this.pointers.entries()].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
        const before = Math.hypot(last.x - other.x, last.y - other.y);
        const after = Math.hypot(event.offsetX - other.x, event.offsetY - other.y);
        if (after > 0 && before > 0) camera.zoom(before / after);
        camera.pan(dx / 2 / canvas.clientHeight, dy / 2 / canvas.clientHeight);
      }
      last.x = event.offsetX;
      last.y = event.offsetY;
      this.moved = true;
    });
    const end = (event: PointerEvent) => {
      const click = this.pointers.delete(event.pointerId) && this.pointers.size === 0 && this.travelled < 6;
      if (click && event.type === "pointerup") this.pick(event.offsetX, event.offsetY);
    };
    canvas.addEventListener("pointerup", end);
    canvas.addEventListener("pointercancel", end);
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        camera.zoom(Math.exp(event.deltaY * 0.001));
        this.moved = true;
      },
      { passive: false },
    );
    canvas.addEventListener("keydown", (event) => {
      const step = 0.08;
      const actions: Record<string, () => void> = {
        ArrowLeft: () => camera.turn(-step, 0),
        ArrowRight: () => camera.turn(step, 0),
        ArrowUp: () => camera.turn(0, step),
        ArrowDown: () => camera.turn(0, -step),
        "+": () => camera.zoom(0.9),
        "-": () => camera.zoom(1 / 0.9),
        f: () => this.frame(),
        "[": () => this.step(-1),
        "]": () => this.step(1),
      };
      const action = actions[event.key];
      if (!action) return;
      event.preventDefault();
      event.stopPropagation();
      action();
      this.moved = true;
    });
  }

  /** Turns the tool about the vertical (rad). */
  turn(angle: number): void {
    this.camera.turn(angle, 0);
    this.moved = true;
  }

  private frame(): void {
    const { geometry } = this.context.store;
    if (!geometry) return;
    const { units } = this.context.settings;
    this.ruler = ruler(geometry.stationPosition, (depth) => convert(depth, "depth", units));
    const points = Float32Array.from([...geometry.stationPosition, ...this.ruler.foot, ...this.ruler.head]);
    this.camera.frame(points, this.canvas.clientWidth / this.canvas.clientHeight);
    this.moved = true;
  }

  /** Selects the next or the previous joint. */
  private step(by: number): void {
    const { geometry } = this.context.store;
    if (!geometry) return;
    const count = geometry.jointDepth.length;
    const joint = ((this.context.location?.joint ?? (by > 0 ? -1 : count)) + by + count) % count;
    this.context.choose({ joint, station: geometry.jointStation[joint] });
  }

  private pick(x: number, y: number): void {
    const { geometry } = this.context.store;
    if (!geometry) return;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    let best = -1;
    let distance = REACH;
    const line = geometry.stationPosition;
    for (let station = 0; station < line.length / 3; station++) {
      const at: Vec3 = [line[3 * station], line[3 * station + 1], line[3 * station + 2]];
      const seen = project(this.matrix, at, width, height);
      if (!seen) continue;
      // Joints draw clicks to them: they are what has an orbit at full rate.
      const joint = geometry.jointStation.includes(station);
      const away = Math.hypot(seen[0] - x, seen[1] - y) * (joint ? 0.6 : 1);
      if (away < distance) [best, distance] = [station, away];
    }
    if (best < 0) return;
    const joint = geometry.jointStation.indexOf(best);
    this.context.choose({ station: best, joint: joint < 0 ? null : joint });
  }

  draw(now: number): void {
    const { context, canvas, renderer } = this;
    const { store, settings, location } = context;
    const moment = store.moment();
    const geometry = store.geometry;
    show(this.past, store.cursor !== null);
    if (store.cursor !== null)
      setText(this.past, `PAST: ${clock(store.cursor)}, ${lapse(store.now - store.cursor)} ago`);
    const known = moment !== null && geometry !== null;
    if (renderer) setText(this.trouble, known ? "" : "No data of a tool yet.");
    show(this.canvas, known);
    show(this.legend, known);
    if (!known || !renderer || canvas.clientWidth === 0) return;
    if (this.moved) this.movedAt = now;
    const turned = renderer.bySoftware && now - this.movedAt < AT_REST;
    const { width, height, ratio } = fit(canvas, turned ? COARSE : renderer.bySoftware ? 1 : FINE);
    // The picture changes with the shape, ten times a second; what else it shows comes along.
    const past = store.cursor === null ? "" : moment.time;
    const key = `${store.shapeRevision} ${past} ${context.revision} ${width}x${height} ${ratio}`;
    if (key === this.drawnKey && !this.moved) return;
    if (now < this.rest) return;
    const size = `${width}x${height} ${settings.units}`;
    const framing = `${geometry.stationDepth.length} ${geometry.stationDepth.at(-1)} ${size}`;
    if (framing !== this.framed) {
      this.framed = framing;
      this.frame();
    }
    if (key !== this.drawnKey) {
      this.meshes.build(
        moment,
        geometry,
        store.session?.tool ?? null,
        settings.exaggeration,
        location?.station ?? null,
      );
      for (const mesh of this.meshes.all()) renderer.upload(mesh);
    }
    this.drawnKey = key;
    this.moved = false;
    this.pictures++;
    this.paint(renderer, width / height);
    this.measure(width, height);
    this.annotate(width, height);
    const taken = performance.now() - now;
    this.rest = store.lag > 0 ? now + taken / SHARE : -Infinity;
  }

  private paint(renderer: Renderer, aspect: number): void {
    const { palette, theme } = this.context;
    const { meshes } = this;
    this.matrix = this.camera.matrix(aspect);
    const [ink, muted, trace] = [palette.ink, palette.muted, palette.trace].map(channels);
    const pipe = theme === "day" ? ([0.42, 0.45, 0.48] as const) : ([0.72, 0.75, 0.78] as const);
    const guide = theme === "day" ? ([0.62, 0.66, 0.7] as const) : ([0.42, 0.47, 0.52] as const);
    const bore = theme === "day" ? ([0.78, 0.75, 0.7] as const) : ([0.36, 0.34, 0.31] as const);
    renderer.begin(this.matrix, this.camera.eye, channels(palette.well));
    renderer.draw(meshes.bore, bore, 1, "back");
    renderer.draw(meshes.guide, guide, 0.35, "back");
    renderer.draw(meshes.pipe, pipe, 1);
    renderer.draw(meshes.joints, muted, 1);
    renderer.draw(meshes.stopped, ink, 1);
    renderer.draw(meshes.pipeGuide, trace, 1);
    renderer.draw(meshes.guideWall, ink, 1);
    renderer.draw(meshes.guide, guide, 0.12, "front", 0.35);
    const levels = [palette.trace, palette.low, palette.medium, palette.high].map(channels);
    meshes.whirl.forEach((mesh, level) => renderer.draw(mesh, levels[level], 0.85));
    renderer.draw(meshes.chosen, ink, 0.9);
    renderer.draw(meshes.bore, bore, 0.04, "front", 0.25);
  }

  /** The scale of vertical depth next to the tool, with the direction of gravity. */
  private measure(width: number, height: number): void {
    if (!this.ruler) return;
    const { settings } = this.context;
    const at = (point: Vec3) => project(this.matrix, point, width, height);
    const segments = [[this.ruler.head, this.ruler.foot], ...this.ruler.ticks.map(({ from, to }) => [from, to])];
    const drawn = segments.map(([from, to]) => [at(from), at(to)]);
    const path = drawn
      .map(([from, to]) => (from && to ? `M${from.map(Math.round).join(" ")}L${to.map(Math.round).join(" ")}` : ""))
      .join("");
    const texts = this.ruler.ticks.map(({ from, value }) => ({ at: at(from), text: `${value}` }));
    const unit = settings.units === "field" ? "ft" : "m";
    const head = at(this.ruler.head);
    // To the left of the scale, where no label of the tool is; the unit alone where the title has no room.
    texts.push({ at: head, text: (head?.[0] ?? 0) < TITLE ? unit : `vertical depth (${unit})` });
    const foot = at(this.ruler.foot);
    const [x, y] = foot ?? [-99, -99];
    const arrow = foot ? `M${x - 5} ${y - 9}L${x} ${y}L${x + 5} ${y - 9}` : "";
    texts.push({ at: foot, text: "down" });
    const label = (entry: (typeof texts)[number], index: number) => {
      if (!entry.at) return "";
      const isTick = index < texts.length - 2;
      const [left, top] = entry.at;
      const shift = isTick ? [-6, 4] : index === texts.length - 2 ? [4, -8] : [0, 15];
      const anchor = index < texts.length - 1 ? "end" : "middle";
      const location = `x="${Math.round(left + shift[0])}" y="${Math.round(top + shift[1])}" text-anchor="${anchor}"`;
      return `<text ${location}>${entry.text}</text>`;
    };
    this.lines.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.lines.innerHTML = `<path d="${path}"/><path d="${arrow}"/>${texts.map(label).join("")}`;
  }

  private annotate(width: number, height: number): void {
    const { store, settings, location } = this.context;
    const geometry = store.geometry;
    if (!geometry) return;
    const labels: { at: Vec3; text: string; level: number }[] = [...this.meshes.labels];
    const station = (index: number): Vec3 => [
      geometry.stationPosition[3 * index],
      geometry.stationPosition[3 * index + 1],
      geometry.stationPosition[3 * index + 2],
    ];
    const last = geometry.stationDepth.length - 1;
    const name = (index: number, word: string) =>
      `${word}, ${withUnit(geometry.stationDepth[index], "depth", settings.units)}`;
    labels.push({ at: station(0), text: name(0, "kick-off"), level: 0 });
    labels.push({ at: station(last), text: name(last, "bit"), level: 0 });
    if (location && location.station <= last) {
      const word = location.joint === null ? "station" : `joint ${location.joint + 1}`;
      labels.push({ at: station(location.station), text: name(location.station, word), level: -1 });
    }
    while (this.overlay.children.length < labels.length) this.overlay.append(h("span", { class: "label" }));
    [...this.overlay.children].forEach((child, index) => {
      const element = child as HTMLElement;
      const label = labels[index];
      const at = label ? project(this.matrix, label.at, width, height) : null;
      show(element, at !== null);
      if (!at || !label) return;
      setText(element, label.level > 0 ? `${PRIORITY_SHAPE[label.level]} ${label.text}` : label.text);
      element.dataset.level = String(label.level);
      const left = Math.round(Math.min(Math.max(at[0], 4), width - 130));
      element.style.transform = `translate(${left}px, ${Math.round(at[1])}px)`;
    });
    const scale = withUnit(this.meshes.fullForce, "force", settings.units);
    setText(
      this.legend,
      `Clearances ×${number(settings.exaggeration, 0)}. Arrows: largest force of the last second on the pipe (blue) ` +
        `and on the guide (${this.context.theme === "day" ? "black" : "white"}), longest arrow ${scale}. ` +
        `Thick collars: joints at their stop. Rings: backward or chaotic whirl.`,
    );
  }
}
