// The hole ahead: where the tool drills in the next metres, from the side and from above, with the plan.

import type { Plan } from "../api";
import { fit, h, setText, show } from "../dom";
import type { HoleAhead, TwinStatus } from "../messages";
import { distance, laid, onHole, type Point } from "../plan";
import type { Store } from "../store/store";
import { stamp } from "../store/topics";
import { channels } from "../theme";
import { valueTicks } from "../ticks";
import { convert, counted, lapse, number, quantity, type System, withUnit } from "../units";
import { type Context, Pace, type View } from "../view";

/** Room for the marks of both axes (pixels). */
const LEFT = 40;
const BELOW = 30;
/** Least time between two pictures (ms). */
const INTERVAL = 500;
/** How much of the hole above the bit is drawn (m). */
const ABOVE = 1.5;
/** How far the plan is drawn beyond the last point ahead (m). */
const BEYOND = 0.5;
/** Least width of what is drawn from above (m): a straight hole is a line and not noise. */
const NARROWEST = 0.5;
/** Metres ahead that the words name. */
const NAMED = [1, 3, 5];
/** Curvature below which a hole counts as straight (1/m): 0.06 degrees per metre. */
const STRAIGHT = 1e-3;

const degrees = (angle: number) => number((angle * 180) / Math.PI, 1);

/** Ends of a range in brackets; nothing where they are not known. */
const within = (low: string, high: string) => (low === "–" || high === "–" ? "" : ` (${low} to ${high})`);

/** Position of a point of the message. */
const point = (hole: HoleAhead, index: number): Point => [
  hole.position_x[index],
  hole.position_y[index],
  hole.position_z[index],
];

/** The index of the point so many metres ahead; -1 where the message does not reach so far. */
function ahead(hole: HoleAhead, metres: number): number {
  const depth = hole.measured_depths[0] + metres;
  // Depths are multiples of a quarter of a metre from the bit, up to rounding.
  return hole.measured_depths.findIndex((at) => Math.abs(at - depth) < 0.01);
}

/** The radius of the next metre in words. */
function radius(hole: HoleAhead, units: System): string {
  const { build_rate: rate, build_rate_low: low, build_rate_high: high } = hole;
  const length = (curvature: number) => withUnit(1 / Math.abs(curvature), "depth", units);
  const figure = (curvature: number) => number(convert(1 / Math.abs(curvature), "depth", units), 2);
  if (!Number.isFinite(hole.radius) || 1 / hole.radius < STRAIGHT) return "Straight over the next metre";
  const what = rate < 0 ? "Dropping with a radius of" : "Radius";
  let range = "";
  if (Number.isFinite(low) && Number.isFinite(high)) {
    // A range that has the straight hole in it has no largest radius.
    if (low > STRAIGHT || high < -STRAIGHT) {
      const [short, long] = [hole.radius_low, hole.radius_high].sort((a, b) => a - b);
      range = within(figure(1 / short), figure(1 / long));
    } else if (high > STRAIGHT) range = ` (${length(high)} to straight${low < -STRAIGHT ? " or dropping" : ""})`;
  }
  return `${what} ${withUnit(hole.radius, "depth", units)} over the next metre${range}`;
}

/** Where the tool drills, in a sentence, or why that is not known. */
export function summary(hole: HoleAhead, units: System): string {
  if (!hole.known)
    return `The hole ahead is not known${hole.because === "" ? "" : `: ${hole.because.replace(/\.$/, "")}`}.`;
  const index = ahead(hole, 3) >= 0 ? ahead(hole, 3) : hole.measured_depths.length - 1;
  if (index <= 0) return `${radius(hole, units)}.`;
  const metres = hole.measured_depths[index] - hole.measured_depths[0];
  const range = within(degrees(hole.inclinations_low[index]), degrees(hole.inclinations_high[index]));
  const after = `${number(convert(metres, "depth", units), units === "si" ? 0 : 1)} ${quantity("depth", units).unit}`;
  return `${radius(hole, units)}; after ${after} inclination ${degrees(hole.inclinations[index])}°${range}.`;
}

/** The ripple, the range of any bit, and what the range rests on. */
export function details(hole: HoleAhead, units: System): string {
  const said: string[] = [];
  if (Number.isFinite(hole.steering_number)) {
    const period = withUnit(hole.free_length, "depth", units);
    said.push(hole.ripples ? `The hole ripples, with a period of about ${period}.` : "The hole does not ripple.");
  }
  const { radius_any_bit_low: low, radius_any_bit_high: high } = hole;
  const [short, long] = [low, high].map((end) => number(convert(end, "depth", units), 2));
  const { unit } = quantity("depth", units);
  if (Number.isFinite(low) && Number.isFinite(high)) {
    said.push(
      `In a long arc at this weight, no bit makes this guide drill a radius outside ${short} to ${long} ${unit}.`,
    );
  }
  const failed = hole.failed > 0 ? `; ${hole.failed} more have no result` : "";
  const range =
    hole.surveys_learnt > 0
      ? `${counted(hole.members, "hole")} that are as likely as the surveys say`
      : counted(hole.members, "plausible tool");
  said.push(`In brackets and in grey: 90 % of ${range}${failed}.`);
  said.push(
    hole.surveys_used > 0
      ? `${counted(hole.surveys_used, "survey")} used, the last ${withUnit(hole.since_survey, "depth", units)} above the bit.`
      : "No survey is used.",
  );
  if (hole.surveys_because) said.push(`Surveys: ${hole.surveys_because.replace(/\.$/, "")}.`);
  return said.join(" ");
}

/** A curvature (1/m) as a radius in words. */
function radiusOf(curvature: number, units: System): string {
  if (Math.abs(curvature) < STRAIGHT) return "a straight hole";
  const length = withUnit(1 / Math.abs(curvature), "depth", units);
  return curvature < 0 ? `a drop with ${length}` : length;
}

/** What the plan needs, how far the hole is behind it, and which weight helps; empty without a plan that is compared. */
export function needs(hole: HoleAhead, units: System): string {
  if (!hole.known) return "";
  if (hole.plan_because) return `The plan is not compared: ${hole.plan_because.replace(/\.$/, "")}.`;
  if (!Number.isFinite(hole.plan_off)) return "";
  const planned = Array.from(hole.plan_inclination, (off, index) => ({ off, index })).filter(({ off }) =>
    isFinite(off),
  );
  // Three metres ahead, or the last station of a plan that ends before them.
  const three = ahead(hole, 3);
  const { off, index } = planned.find((at) => at.index === three) ?? planned[planned.length - 1];
  const metres = hole.measured_depths[index] - hole.measured_depths[0];
  const places = units === "si" && Number.isInteger(metres) ? 0 : 1;
  const after = `${number(convert(metres, "depth", units), places)} ${quantity("depth", units).unit}`;
  const side = off < 0 ? "behind" : "ahead of";
  const said = [
    `The plan needs ${radiusOf(hole.plan_build_rate, units)}: ${degrees(Math.abs(off))}° ${side} it after ${after}.`,
  ];
  const weight = (force: number) => withUnit(force, "weight", units);
  const nearest = Number.isFinite(hole.plan_nearest_weight)
    ? `${weight(hole.plan_nearest_weight)}: ${radiusOf(1 / hole.plan_nearest_radius, units)}`
    : "";
  if (hole.plan_no_guide) said.push("This guide cannot drill the plan at any weight; change the guide.");
  else if (Number.isFinite(hole.plan_weight)) said.push(`At ${nearest}.`);
  else if (hole.plan_no_weight) {
    const range = `${weight(hole.plan_weight_low)} to ${weight(hole.plan_weight_high)}`;
    said.push(`No weight from ${range} brings it back${nearest === "" ? "" : `; at ${nearest}`}.`);
  }
  return said.join(" ");
}

/** Distances to the plan in words; empty without a plan. The plan is laid as points, and ends at its last station. */
export function toPlan(hole: HoleAhead, points: readonly Point[], plan: Plan | null, units: System): string {
  if (!hole.known || !plan || points.length < 2) return "";
  const { unit } = quantity("depth", units);
  const end = plan.stations[plan.stations.length - 1].measured_depth;
  const found = NAMED.map((metres) => ({ metres, index: ahead(hole, metres) })).filter(
    // Beyond the end of a plan there is no distance to it.
    ({ index }) => index >= 0 && hole.measured_depths[index] <= end,
  );
  if (found.length === 0) return "The plan ends here.";
  const length = (of: number, places: number) => number(convert(of, "depth", units), places);
  const parts = found.map(({ metres, index }) => {
    const off = distance(points, point(hole, index));
    const judged = off > plan.target ? ", off target" : "";
    return `${length(off, 2)} ${unit} after ${length(metres, units === "si" ? 0 : 1)} ${unit}${judged}`;
  });
  const { index } = found[found.length - 1];
  const share = hole.plan_within?.[index] ?? NaN;
  // The last metre that is named: before it as many stay, or more.
  const stay = Number.isFinite(share) ? `; ${number(100 * share, 0)} % of the plausible tools stay on target` : "";
  return `From the plan: ${parts.join("; ")} (target ${length(plan.target, 2)} ${unit}${stay}).`;
}

/** A picture's coordinates: two lengths (m), the second down. */
export type Place = [number, number];

/** What is drawn in one of the pictures. */
export interface Drawing {
  hole: Place[];
  path: Place[];
  /** Outline of where 90 % of the plausible tools are. */
  cone: Place[];
  plan: Place[];
  /** Both edges of the target around the plan. */
  target: [Place[], Place[]];
  /** Where surveys were made. */
  surveys: Place[];
}

/** A line beside another one, at a distance (m) to its left. */
function offset(line: readonly Place[], by: number): Place[] {
  return line.map(([x, y], index) => {
    const [from, to] = [line[Math.max(index - 1, 0)], line[Math.min(index + 1, line.length - 1)]];
    const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    const length = Math.hypot(dx, dy);
    return length > 0 ? [x + (by * dy) / length, y - (by * dx) / length] : [x, y];
  });
}

/** What is drawn from the `side` or from `above`. */
export function drawing(
  hole: HoleAhead,
  drilled: readonly Point[],
  plan: readonly Point[],
  target: number,
  of: "side" | "above",
  surveys: readonly Point[] = [],
): Drawing {
  const view = ([x, y, z]: Point): Place => (of === "side" ? [x, z] : [x, y]);
  const edge = (sign: number) =>
    Array.from(hole.measured_depths, (_, index): Place => {
      const [inclination, azimuth] = [hole.inclinations[index], hole.azimuths[index]];
      const [cosine, east, north] = [Math.cos(inclination), Math.sin(azimuth), Math.cos(azimuth)];
      const [unit, half]: [Point, number] =
        of === "side"
          ? [[cosine * north, cosine * east, -Math.sin(inclination)], hole.half_width_high[index]]
          : [[-east, north, 0], hole.half_width_right[index]];
      return view(point(hole, index).map((part, axis) => part + sign * half * unit[axis]) as Point);
    }).filter((place) => place.every(Number.isFinite));
  const planned = plan.map(view);
  return {
    hole: drilled.map(view),
    path: Array.from(hole.measured_depths, (_, index) => view(point(hole, index))),
    cone: [...edge(1), ...edge(-1).reverse()],
    plan: planned,
    target: planned.length > 1 ? [offset(planned, target), offset(planned, -target)] : [[], []],
    surveys: surveys.map(view),
  };
}

/** The hole as configured near the bit. */
export function drilledOf(store: Store, bit: number): Point[] {
  const stations = store.session?.tool?.stations ?? [];
  const near = stations.filter(({ measured_depth: depth }) => depth >= bit - ABOVE && depth <= bit + 0.01);
  return near.flatMap(({ position }) => (position ? [position] : []));
}

/** The places of the surveys near the bit, on the hole as configured. */
export function surveyed(store: Store, hole: HoleAhead): Point[] {
  const { tool } = store.session ?? {};
  const bit = hole.measured_depths[0];
  // A twin of an older version lists none.
  const near = Array.from(hole.survey_depths ?? []).filter((depth) => depth >= bit - ABOVE);
  return tool ? near.flatMap((depth) => [onHole(tool, depth)].filter((place) => place !== null)) : [];
}

/** What the twin has counted of the surveys that came: heading and value of each count, a dash where it is not known. */
export function surveyCounts(status: TwinStatus | null): [string, string][] {
  // A twin of an older version counts none.
  const { surveys_known: used, surveys_waiting: waiting, surveys_refused: refused } = status ?? {};
  const accepted = used === undefined || waiting === undefined ? undefined : used + waiting;
  const digits = (count: number | undefined) => number(count ?? NaN, 0);
  return [
    ["accepted", digits(accepted)],
    ["used", digits(used)],
    ["below the bit", digits(waiting)],
    ["refused", digits(refused)],
  ];
}

/** Why nothing is drawn now; null where a known hole is of the present. */
export function withheld(store: Store): string | null {
  if (!store.isBag && store.cursor !== null) return "The hole ahead is of the present.";
  if (store.silent) return "Withdrawn: the twin is silent.";
  if (!store.hole) return "The twin publishes no hole ahead, or its first answer is not there yet.";
  if (!store.holeNow) return "Withdrawn: no newer answer has come.";
  return null;
}

/** Ends of what is drawn along an axis. */
function ends(places: readonly Place[], axis: 0 | 1): [number, number] {
  const values = places.map((place) => place[axis]);
  return [Math.min(...values), Math.max(...values)];
}

/** A picture: canvas with axes that shows a drawing. */
class Picture {
  readonly element: HTMLElement;
  private readonly canvas: HTMLCanvasElement;
  private drawn = "";

  constructor(
    private readonly context: Context,
    private readonly of: "side" | "above",
    heading: string,
  ) {
    this.canvas = h("canvas", {
      id: `hole-${of}`,
      role: "img",
      "aria-label": `The hole ahead ${heading.toLowerCase()}`,
    });
    this.element = h("figure", { class: "hole-picture" }, h("figcaption", { class: "hint" }, heading), this.canvas);
  }

  draw(drawing: Drawing, key: string): void {
    const size = fit(this.canvas);
    const whole = `${key} ${size.width} ${size.height} ${size.ratio}`;
    if (whole === this.drawn || size.width < LEFT || size.height < BELOW) return;
    this.drawn = whole;
    this.paint(drawing, size);
  }

  private paint(drawing: Drawing, { width, height, ratio }: { width: number; height: number; ratio: number }): void {
    const pencil = this.canvas.getContext("2d");
    if (!pencil) return;
    const { palette } = this.context;
    pencil.setTransform(ratio, 0, 0, ratio, 0, 0);
    pencil.clearRect(0, 0, width, height);
    const [across, down] = this.scales(drawing, width, height);
    this.axes(pencil, across, down, width, height);
    pencil.save();
    pencil.beginPath();
    pencil.rect(LEFT, 0, width - LEFT, height - BELOW);
    pencil.clip();
    const line = (places: readonly Place[], colour: string, thick: number, dashes: number[] = []) => {
      pencil.beginPath();
      for (const [x, y] of places) pencil.lineTo(across.to(x), down.to(y));
      pencil.setLineDash(dashes);
      pencil.strokeStyle = colour;
      pencil.lineWidth = thick;
      pencil.stroke();
      pencil.setLineDash([]);
    };
    // What is not known lies under what is.
    if (drawing.cone.length > 2) {
      const [from, to] = [channels(palette.well), channels(palette.trace)];
      pencil.beginPath();
      for (const [x, y] of drawing.cone) pencil.lineTo(across.to(x), down.to(y));
      pencil.closePath();
      pencil.fillStyle = `rgb(${[0, 1, 2].map((index) => Math.round(255 * (0.72 * from[index] + 0.28 * to[index])))})`;
      pencil.fill();
    }
    for (const edge of drawing.target) line(edge, palette.limit, 1, [2, 4]);
    line(drawing.plan, palette.ink, 1.5, [7, 5]);
    line(drawing.hole, palette.muted, 4);
    line(drawing.path, palette.trace, 2.5);
    pencil.fillStyle = palette.limit;
    for (const [x, y] of drawing.surveys) pencil.fillRect(across.to(x) - 3, down.to(y) - 3, 6, 6);
    // The bit.
    const bit = drawing.path[0];
    if (bit) {
      pencil.beginPath();
      pencil.arc(across.to(bit[0]), down.to(bit[1]), 5, 0, 2 * Math.PI);
      pencil.fillStyle = palette.ink;
      pencil.fill();
      pencil.strokeStyle = palette.panel;
      pencil.lineWidth = 2;
      pencil.stroke();
    }
    pencil.restore();
  }

  /** Both scales: from the side one metre is as long along both axes; from above the width is enlarged. */
  private scales(drawing: Drawing, width: number, height: number): [Scale, Scale] {
    const { hole, path, cone } = drawing;
    const shown = [...hole, ...path, ...cone];
    // A plan that has left the picture does not make it small.
    const [left, right] = ends(shown, 0);
    let [top, bottom] = ends(shown, 1);
    const room = [width - LEFT - 16, height - BELOW - 16];
    const middle = (top + bottom) / 2;
    if (this.of === "above") {
      const half = Math.max(bottom - top, NARROWEST) / 2;
      [top, bottom] = [middle - half, middle + half];
    }
    const alone = [room[0] / Math.max(right - left, 0.1), room[1] / Math.max(bottom - top, 0.1)];
    const equal = Math.min(...alone);
    const [perX, perY] = this.of === "side" ? [equal, equal] : alone;
    return [
      new Scale(perX, LEFT + 8 + room[0] / 2 - (perX * (left + right)) / 2),
      new Scale(perY, 8 + room[1] / 2 - perY * middle),
    ];
  }

  private axes(pencil: CanvasRenderingContext2D, across: Scale, down: Scale, width: number, height: number): void {
    const { palette, settings } = this.context;
    const { unit, factor } = quantity("depth", settings.units);
    pencil.fillStyle = palette.muted;
    pencil.strokeStyle = palette.line;
    pencil.lineWidth = 1;
    pencil.font = "11px system-ui, sans-serif";
    const places = (values: number[]) => (values.length > 1 && values[1] - values[0] < 1 ? 1 : 0);
    pencil.textAlign = "center";
    pencil.textBaseline = "top";
    const most = Math.max(2, Math.floor((width - LEFT) / 60));
    const columns = valueTicks(across.from(LEFT) * factor, across.from(width) * factor, most);
    for (const value of columns) {
      const at = across.to(value / factor);
      pencil.strokeRect(Math.round(at) + 0.5, 0.5, 0, height - BELOW - 1);
      if (at > LEFT + 8 && at < width - 12) pencil.fillText(number(value, places(columns)), at, height - BELOW + 3);
    }
    const along = this.of === "side" ? "along" : "along; across is enlarged";
    pencil.fillText(`${along} (${unit})`, LEFT + (width - LEFT) / 2, height - 13);
    pencil.textAlign = "right";
    pencil.textBaseline = "middle";
    const rows = valueTicks(down.from(0) * factor, down.from(height - BELOW) * factor, Math.max(2, height / 45));
    // A narrow axis has steps of less than a tenth.
    const fine = rows.length > 1 && rows[1] - rows[0] < 0.1 ? 2 : places(rows);
    for (const value of rows) {
      const at = down.to(value / factor);
      pencil.strokeRect(LEFT + 0.5, Math.round(at) + 0.5, width - LEFT - 1, 0);
      if (at > 8 && at < height - BELOW - 6) pencil.fillText(number(value, fine), LEFT - 4, at);
    }
    pencil.strokeRect(LEFT + 0.5, 0.5, width - LEFT - 1, height - BELOW - 1);
    pencil.save();
    pencil.translate(7, (height - BELOW) / 2);
    pencil.rotate(-Math.PI / 2);
    pencil.textAlign = "center";
    pencil.fillText(`${this.of === "side" ? "down" : "right"} (${unit})`, 0, 0);
    pencil.restore();
  }
}

/** Pixels of lengths (m). */
class Scale {
  constructor(
    private readonly per: number,
    private readonly zero: number,
  ) {}

  to(length: number): number {
    return this.zero + this.per * length;
  }

  from(pixels: number): number {
    return (pixels - this.zero) / this.per;
  }
}

export class HoleView implements View {
  readonly element: HTMLElement;
  private readonly said = h("p", { id: "hole-summary", class: "hole-summary" });
  private readonly state = h("p", { class: "hint", id: "hole-state" });
  private readonly planned = h("p", { id: "hole-plan" });
  private readonly rest = h("p", { class: "hint", id: "hole-details" });
  private readonly counts = surveyCounts(null).map(() => h("td", {}));
  private readonly body: HTMLElement;
  private readonly pictures: [Picture, Picture];
  private readonly target = h("span", {}, "⋯ target");
  private readonly plan = h("span", {}, "- - plan");
  private readonly surveys = h("span", {}, "■ surveys");
  private readonly pace = new Pace(INTERVAL);

  constructor(private readonly context: Context) {
    this.pictures = [new Picture(context, "side", "From the side"), new Picture(context, "above", "From above")];
    this.body = h(
      "div",
      {},
      h("div", { class: "hole-pictures" }, this.pictures[0].element, this.pictures[1].element),
      h(
        "p",
        { class: "hint keys" },
        h("span", {}, "● bit"),
        h("span", {}, "━ hole as configured"),
        h("span", {}, "— ahead"),
        this.surveys,
        h("span", {}, h("i", { class: "key cone" }), " 90 % of what is plausible"),
        this.plan,
        this.target,
      ),
      this.rest,
    );
    this.element = h(
      "section",
      { class: "hole", "aria-label": "Hole ahead" },
      h("h2", {}, "The hole ahead"),
      this.said,
      this.planned,
      this.state,
      this.body,
      h(
        "table",
        { class: "transfer-table", id: "hole-surveys" },
        h("thead", {}, h("tr", {}, h("td", {}), ...surveyCounts(null).map(([of]) => h("th", { scope: "col" }, of)))),
        h("tbody", {}, h("tr", {}, h("th", { scope: "row" }, "Surveys"), ...this.counts)),
      ),
    );
  }

  draw(now: number): void {
    const { context } = this;
    if (this.element.clientWidth === 0 || !this.pace.due(now, context.revision)) return;
    const { store, settings } = context;
    const hole = store.holeNow;
    const why = withheld(store);
    // Counts are of the present, as the answer is.
    const isPresent = store.isBag || (store.cursor === null && !store.silent);
    surveyCounts(isPresent ? store.status : null).forEach(([, count], at) => setText(this.counts[at], count));
    const isKnown = why === null && hole !== null && hole.known && hole.measured_depths.length > 1;
    show(this.body, isKnown);
    if (why !== null || !hole) {
      for (const element of [this.said, this.planned]) setText(element, "");
      return setText(this.state, why ?? "");
    }
    setText(this.said, summary(hole, settings.units));
    setText(this.state, this.made(hole));
    if (!isKnown) return setText(this.planned, "");
    const { tool } = store.session ?? {};
    const bit = hole.measured_depths[0];
    const last = hole.measured_depths[hole.measured_depths.length - 1];
    const plan = tool ? laid(tool, bit, last + BEYOND) : [];
    const target = tool?.plan?.target ?? NaN;
    for (const key of [this.plan, this.target]) show(key, plan.length > 1);
    setText(
      this.planned,
      tool?.plan?.file
        ? `The plan of ${tool.plan.file} is not shown: only stations in the configuration are (well.plan.stations).`
        : `${needs(hole, settings.units)} ${toPlan(hole, plan, tool?.plan ?? null, settings.units)}`.trim(),
    );
    setText(this.rest, details(hole, settings.units));
    const key = `${hole.header.stamp.sec} ${hole.header.stamp.nanosec} ${hole.members} ${context.revision}`;
    const drilled = drilledOf(store, bit);
    const surveys = surveyed(store, hole);
    show(this.surveys, surveys.length > 0);
    this.pictures[0].draw(drawing(hole, drilled, plan, target, "side", surveys), key);
    this.pictures[1].draw(drawing(hole, drilled, plan, target, "above", surveys), key);
  }

  /** When and under which weight the bit was as the message says. */
  private made(hole: HoleAhead): string {
    const { store, settings } = this.context;
    const age = lapse(Math.max(0, store.now - stamp(hole.header)));
    const weight = Number.isFinite(hole.weight_on_bit)
      ? ` at ${withUnit(hole.weight_on_bit, "weight", settings.units)}`
      : "";
    return `The bit at ${withUnit(hole.measured_depth, "depth", settings.units)}${weight}, ${age} ago.`;
  }
}
