// The orbit of the pipe's axis, looking down the hole: forward whirl turns clockwise.

import { fit } from "../dom";
import type { Motion } from "../store/motion";
import { roundUp } from "../ticks";
import { convert, digits, number, quantity } from "../units";
import type { Context } from "../view";

/** Length of the trail (s): two turns at 40 r/min. */
const TRAIL = 3;
/** Positions that are further apart in time than this (s) are not joined: what lies between is not known. */
const APART = 0.5;
/** The spectrum's least full height, as a part of the clearance: what a tool at rest has is flat. */
const LEAST = 0.1;

export function drawOrbit(
  canvas: HTMLCanvasElement,
  context: Context,
  pipe: Motion,
  guide: [number, number],
  clearances: { pipe: number; guide: number },
): void {
  const { width, height, ratio } = fit(canvas);
  const pencil = canvas.getContext("2d");
  if (!pencil || width === 0) return;
  const { palette, settings } = context;
  pencil.setTransform(ratio, 0, 0, ratio, 0, 0);
  pencil.clearRect(0, 0, width, height);
  const reach = clearances.pipe + clearances.guide;
  const scale = (Math.min(width, height) / 2 - 22) / reach;
  const [cx, cy] = [width / 2, height / 2];
  const circle = (y: number, z: number, radius: number) => {
    pencil.beginPath();
    pencil.arc(cx + y * scale, cy + z * scale, radius * scale, 0, 2 * Math.PI);
    pencil.stroke();
  };
  pencil.strokeStyle = palette.line;
  pencil.lineWidth = 1;
  pencil.beginPath();
  pencil.moveTo(cx - reach * scale, cy);
  pencil.lineTo(cx + reach * scale, cy);
  pencil.moveTo(cx, cy - reach * scale);
  pencil.lineTo(cx, cy + reach * scale);
  pencil.stroke();
  pencil.strokeStyle = palette.muted;
  pencil.lineWidth = 2;
  circle(0, 0, reach);
  pencil.lineWidth = 1.5;
  pencil.setLineDash([5, 4]);
  circle(guide[0], guide[1], clearances.pipe);
  pencil.setLineDash([]);
  const last = pipe.times.length - 1;
  pencil.strokeStyle = palette.trace;
  pencil.lineWidth = 2;
  for (let index = 1; index <= last; index++) {
    const age = pipe.times[last] - pipe.times[index];
    if (age > TRAIL || pipe.times[index] - pipe.times[index - 1] > APART) continue;
    pencil.globalAlpha = 1 - 0.9 * (age / TRAIL);
    pencil.beginPath();
    pencil.moveTo(cx + pipe.y[index - 1] * scale, cy + pipe.z[index - 1] * scale);
    pencil.lineTo(cx + pipe.y[index] * scale, cy + pipe.z[index] * scale);
    pencil.stroke();
  }
  pencil.globalAlpha = 1;
  if (last >= 0) {
    pencil.fillStyle = palette.ink;
    pencil.beginPath();
    pencil.arc(cx + pipe.y[last] * scale, cy + pipe.z[last] * scale, 5, 0, 2 * Math.PI);
    pencil.fill();
  }
  pencil.fillStyle = palette.muted;
  pencil.font = "11px system-ui, sans-serif";
  pencil.textAlign = "left";
  pencil.fillText("high side", 4, 11);
  pencil.textAlign = "center";
  pencil.fillText("low side", cx, height - 4);
  pencil.textAlign = "right";
  const unit = quantity("gap", settings.units).unit;
  pencil.fillText(`± ${digits(reach, "gap", settings.units)} ${unit}`, width - 4, 11);
}

/** Full height of a spectrum (m) whose highest line is `top`, in a clearance. */
export function fullHeight(top: number, clearance: number): number {
  // In whole nanometres: 1e-4 m itself would be rounded up to 2e-4 m.
  return Math.max(roundUp(Math.round(top * 1e9)) / 1e9, LEAST * clearance);
}

/**
 * Full spectrum: backward to the left, forward to the right; marks at multiples of the tool's speed. Its height is an
 * amplitude, the same for a tool at rest.
 */
export function drawSpectrum(
  canvas: HTMLCanvasElement,
  context: Context,
  lines: { frequency: Float64Array; amplitude: Float64Array } | null,
  turns: number,
  clearance: number,
): void {
  const { width, height, ratio } = fit(canvas);
  const pencil = canvas.getContext("2d");
  if (!pencil || width === 0) return;
  const { palette, settings } = context;
  pencil.setTransform(ratio, 0, 0, ratio, 0, 0);
  pencil.clearRect(0, 0, width, height);
  const most = turns > 0.05 ? Math.max(3, 5 * turns) : 5;
  const floor = height - 18;
  const x = (frequency: number) => width / 2 + (frequency / most) * (width / 2 - 8);
  pencil.font = "11px system-ui, sans-serif";
  pencil.textAlign = "center";
  pencil.strokeStyle = palette.line;
  pencil.fillStyle = palette.muted;
  pencil.lineWidth = 1;
  const step = turns > 0.05 ? turns : 1;
  for (let line = -4; line <= 4; line++) {
    if (Math.abs(line * step) > most) continue;
    pencil.beginPath();
    pencil.moveTo(x(line * step), 14);
    pencil.lineTo(x(line * step), floor);
    pencil.stroke();
    const text = turns > 0.05 ? (line === 0 ? "0" : `${line}×`) : `${line}`;
    pencil.fillText(text.replace("-", "−"), x(line * step), height - 5);
  }
  if (lines) {
    let top = 0;
    for (let index = 0; index < lines.frequency.length; index++) {
      if (Math.abs(lines.frequency[index]) <= most) top = Math.max(top, lines.amplitude[index]);
    }
    const full = fullHeight(top, clearance);
    if (top > 0) {
      pencil.fillStyle = palette.trace;
      const wide = Math.max(1.5, x(lines.frequency[1]) - x(lines.frequency[0]) - 0.5);
      for (let index = 0; index < lines.frequency.length; index++) {
        if (Math.abs(lines.frequency[index]) > most) continue;
        const tall = (lines.amplitude[index] / full) * (floor - 18);
        pencil.fillRect(x(lines.frequency[index]) - wide / 2, floor - tall, wide, tall);
      }
    }
    // The scale of the amplitude: its full height, and half of it.
    const { unit, digits: places } = quantity("gap", settings.units);
    pencil.fillStyle = palette.muted;
    pencil.textAlign = "left";
    for (const share of [1, 0.5]) {
      const y = floor - share * (floor - 18);
      pencil.globalAlpha = 0.4;
      pencil.fillRect(0, y, width, 1);
      pencil.globalAlpha = 1;
      pencil.fillText(`${number(convert(share * full, "gap", settings.units), places + 1)} ${unit}`, 4, y + 11);
    }
  }
  pencil.fillStyle = palette.ink;
  pencil.textAlign = "left";
  pencil.fillText("◂ backward", 4, 11);
  pencil.textAlign = "right";
  pencil.fillText("forward ▸", width - 4, 11);
}
