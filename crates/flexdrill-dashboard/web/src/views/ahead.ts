// Looking ahead: the forecast, plausible tools, questions, and the map of speed and weight.

import { h } from "../dom";
import type { Context, View } from "../view";
import { ForecastView } from "./forecast";
import { PlausibleView } from "./plausible";
import { WhatIfView } from "./what_if";
import { WindowView } from "./window";

export class AheadView implements View {
  readonly element: HTMLElement;
  private readonly views: View[];

  constructor(context: Context) {
    const forecast = new ForecastView(context);
    const plausible = new PlausibleView(context);
    const question = new WhatIfView(context);
    const map = new WindowView(
      context,
      (rpm, kilonewton) => question.fill(rpm, kilonewton),
      () => question.asked?.answers ?? [],
    );
    this.views = [forecast, plausible, question, map];
    this.element = h("div", { class: "ahead" }, forecast.element, plausible.element, map.element, question.element);
  }

  draw(now: number): void {
    for (const view of this.views) view.draw(now);
  }
}
