// The page at four sizes, by day and at night: nothing is cut off or runs out of the picture, fingers find every button.
import assert from "node:assert/strict";
import { join } from "node:path";

export const SIZES = [
  [1920, 1080],
  [1366, 768],
  [768, 1024],
  [390, 844],
];
/** Narrower than this the page is for fingers. */
const TOUCH = 1100;
/** Least height and width of what is pressed (pixels). */
const FINGER = 44;

/** What is wrong with the page as it is. */
function faults([touch, finger]) {
  const out = [];
  const { scrollWidth } = document.documentElement;
  if (scrollWidth > innerWidth) out.push(`the page is ${scrollWidth} pixels wide, the screen ${innerWidth}`);
  const words = (element) => (element.textContent || element.id || element.className).trim().slice(0, 40);
  const seen = (element) => element.getClientRects().length > 0;
  for (const selector of ["#state-word", "#state-sentence"]) {
    const element = document.querySelector(selector);
    if (!element || !seen(element)) continue;
    const { right } = element.getBoundingClientRect();
    if (
      right > innerWidth + 1 ||
      element.scrollWidth > element.clientWidth + 1 + (element.clientWidth === 0 ? 1e6 : 0)
    ) {
      out.push(`${selector} is cut off: ${words(element)}`);
    }
  }
  for (const element of document.querySelectorAll(".value")) {
    if (seen(element) && element.scrollWidth > element.parentElement.clientWidth) out.push(`${element.id} is cut off`);
  }
  for (const element of document.querySelectorAll(".tile .note")) {
    if (!seen(element)) continue;
    const { bottom } = element.getBoundingClientRect();
    // A pixel of the last line's descent may lie on the tile's edge.
    const below = bottom - element.parentElement.getBoundingClientRect().bottom > 1;
    const cut = element.scrollWidth > element.clientWidth + 1 || element.scrollHeight > element.clientHeight + 1;
    if (below || cut) out.push(`the note is cut off: ${words(element)}`);
  }
  for (const element of document.querySelectorAll(".tabs button, .facts .fact, .badge")) {
    if (seen(element) && element.scrollWidth > element.clientWidth + 1) out.push(`${words(element)} is cut off`);
  }
  // Their words are apart: each has room on both sides.
  for (const element of document.querySelectorAll(".tabs button")) {
    if (!seen(element)) continue;
    const range = document.createRange();
    range.selectNodeContents(element);
    const [text, box] = [range.getBoundingClientRect(), element.getBoundingClientRect()];
    if (text.left - box.left < 3 || box.right - text.right < 3) out.push(`the tab "${words(element)}" touches another`);
  }
  const leading = document.querySelector("#alarm-list .alarm");
  if (leading && seen(leading)) {
    // In the first screen, wherever the page has been scrolled to.
    const top = leading.getBoundingClientRect().top + scrollY;
    if (top > innerHeight)
      out.push(`the first alarm begins ${Math.round(top)} pixels down, the screen has ${innerHeight}`);
    if (document.querySelector("#alarm-list details[open]")) out.push("an alarm is open that was not opened");
  }
  if (innerWidth >= touch) return out;
  for (const element of document.querySelectorAll("button, select, input:not([type=checkbox]), summary")) {
    if (!seen(element)) continue;
    const { width, height } = element.getBoundingClientRect();
    if (height < finger - 0.5 || width < (element.matches(".link, summary") ? 0 : finger - 0.5)) {
      out.push(`${element.tagName} "${words(element)}" is ${Math.round(width)} x ${Math.round(height)} pixels`);
    }
  }
  return out;
}

/** Looks at the page in all sizes; keeps pictures where a folder is given. */
export async function look(page, name, shots) {
  const before = page.viewportSize();
  const theme = await page.evaluate(() => window.flexdrill.context.settings.theme);
  const found = [];
  for (const [width, height] of SIZES) {
    await page.setViewportSize({ width, height });
    for (const colours of shots === "" ? ["day"] : ["day", "night"]) {
      for (const wall of [false, true]) {
        await page.evaluate(
          ([theme, wall]) => {
            const { context } = window.flexdrill;
            context.change({ theme });
            context.showWall(wall);
          },
          [colours, wall],
        );
        await page.waitForTimeout(shots === "" ? 300 : 1200);
        const which = `${name}_${width}_${colours}${wall ? "_wall" : ""}`;
        for (const fault of await page.evaluate(faults, [TOUCH, FINGER])) found.push(`${which}: ${fault}`);
        if (shots !== "") await page.screenshot({ path: join(shots, `${which}.png`) });
      }
    }
    // A panel is as long as what it holds: the whole of it.
    if (shots !== "" && width < TOUCH) {
      await page.evaluate(() => window.flexdrill.context.showWall(false));
      await page.screenshot({ path: join(shots, `${name}_${width}_full.png`), fullPage: true });
    }
  }
  await page.evaluate((theme) => {
    window.flexdrill.context.change({ theme });
    window.flexdrill.context.showWall(false);
  }, theme);
  await page.setViewportSize(before);
  assert.deepEqual(found, [], "what is wrong with the page");
}
