// What a bridge makes of the items of the rig's line, and the click that confirms it.

import * as api from "../api";
import { h, setText, show } from "../dom";
import type { Context, View } from "../view";
import { printable } from "../words";

/** Time between two requests (ms); the bridge sends once a second. */
const ASK = 2000;

/** A row of the table: item, quantity, value as sent and as used. */
export function row(item: api.MappedItem): string[] {
  const quantity = item.quantity === "" ? "not read" : item.quantity.replace(/_/g, " ");
  return [item.item, quantity, item.sent, item.used].map(printable);
}

/** What the page says of a mapping, in a sentence. */
export function said(mapping: api.Mapping): string {
  const file = mapping.file === "default" ? "the default mapping" : mapping.file;
  const head = printable(`${mapping.address} by ${file}`);
  return mapping.confirmed === ""
    ? `SUSPECT: no person has confirmed what the bridge makes of ${head}. Compare the first values with the rig's display.`
    : `${head}: confirmed ${printable(mapping.confirmed)}.`;
}

/** How a mapping that waits can be confirmed from here; empty where the button does it. */
export function way(mapping: api.Mapping, control: boolean): string {
  if (mapping.confirmed !== "" || mapping.can_confirm) return "";
  const terminal = "c and Enter in the terminal of the bridge, or --confirm";
  return control
    ? `To confirm: ${terminal}. This page reaches a bridge of the usual name only.`
    : `To confirm: ${terminal}, or a page of a server with --allow-control.`;
}

export class MappingView implements View {
  readonly element: HTMLElement;
  private readonly list = h("div", {});
  private readonly operator: HTMLInputElement;
  private readonly form: HTMLElement;
  private readonly answer = h("p", { class: "answer", role: "status", id: "mapping-answer" });
  private asked = -Infinity;
  private key = "";

  constructor(private readonly context: Context) {
    this.operator = h("input", {
      type: "text",
      id: "mapping-operator",
      maxlength: "60",
      value: context.settings.operator,
    });
    this.form = h("div", { class: "control" }, h("label", {}, "operator", this.operator));
    this.element = h(
      "section",
      { "aria-label": "Items of the rig's line", id: "mapping" },
      h("h2", {}, "Items of the rig's line"),
      this.list,
      this.form,
      this.answer,
    );
    show(this.element, false);
  }

  draw(now: number): void {
    const { store } = this.context;
    const isOpen = this.element.parentElement !== null && this.element.parentElement.clientWidth > 0;
    if (store.isBag || !isOpen || now - this.asked < ASK) return;
    this.asked = now;
    void api.mappings().then((all) => this.fill(all ?? []));
  }

  private fill(all: readonly api.Mapping[]): void {
    show(this.element, all.length > 0);
    show(
      this.form,
      all.some((mapping) => mapping.confirmed === "" && mapping.can_confirm),
    );
    // A list that is drawn again under a finger would take the click.
    const key = JSON.stringify(all);
    if (key === this.key) return;
    this.key = key;
    this.list.replaceChildren(...all.flatMap((mapping) => this.table(mapping)));
  }

  private table(mapping: api.Mapping): HTMLElement[] {
    const control = this.context.store.session?.control === true;
    const heads = ["item", "quantity", "as sent", "as used"].map((text) => h("th", { scope: "col" }, text));
    const rows = mapping.items.map((item) => {
      const [code, ...cells] = row(item);
      return h("tr", {}, h("th", { scope: "row" }, code), ...cells.map((text) => h("td", {}, text)));
    });
    const parts: HTMLElement[] = [
      h("p", { class: "mapping-state" }, said(mapping)),
      h("table", { class: "transfer-table" }, h("thead", {}, h("tr", {}, ...heads)), h("tbody", {}, ...rows)),
    ];
    if (mapping.not_shown !== "") parts.push(h("p", { class: "hint" }, `${printable(mapping.not_shown)} more`));
    const hint = way(mapping, control);
    if (hint !== "") parts.push(h("p", { class: "hint" }, hint));
    if (mapping.confirmed === "" && mapping.can_confirm) {
      const click = () => void this.confirm(mapping);
      parts.push(
        h("button", { type: "button", class: "mapping-confirm", onclick: click }, "The values are the rig's: confirm"),
      );
    }
    return parts;
  }

  private async confirm(mapping: api.Mapping): Promise<void> {
    const operator = this.operator.value.trim();
    if (operator === "") return this.say(false, "Enter your name: it stands in the journal.");
    this.context.change({ operator });
    const wanted = { operator, source: mapping.source, mapping: mapping.mapping };
    const { ok, message } = await api.request("confirm_mapping", wanted);
    this.say(ok, message || (ok ? "confirmed" : "refused"));
    this.asked = -Infinity;
  }

  private say(ok: boolean, message: string): void {
    this.answer.dataset.ok = String(ok);
    setText(this.answer, `${ok ? "✓" : "✕"} ${printable(message)}`);
  }
}
