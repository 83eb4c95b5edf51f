// Looking ahead: the forecast, and questions.

import { h } from "../dom";
import type { Context, View } from "../view";
import { ForecastView } from "./forecast";
import { WhatIfView } from "./what_if";

export class AheadView implements View {
  readonly element: HTMLElement;
  private readonly views: View[];

  constructor(context: Context) {
    const forecast = new ForecastView(context);
    const question = new WhatIfView(context);
    this.views = [forecast, question];
    this.element = h("div", { class: "ahead" }, forecast.element, question.element);
  }

  draw(now: number): void {
    for (const view of this.views) view.draw(now);
  }
}
