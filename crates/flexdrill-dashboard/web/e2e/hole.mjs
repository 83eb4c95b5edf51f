// An answer where the tool drills, as a twin whose guide has a free curvature publishes it.

/** Puts an answer and a plan in place of the twin's own, once a second, until `restore`. `known` false has a reason. */
export async function impose(page, known) {
  await page.evaluate((known) => {
    const { store } = window.flexdrill;
    // The end of a quarter circle of 3.2 m, continued with 3.57 m.
    const [bit, radius] = [(3.2 * Math.PI) / 2, 3.57];
    const ahead = Array.from({ length: known ? 21 : 0 }, (_, index) => 0.25 * index);
    const column = (of) => Float64Array.from(ahead, of);
    const inclination = (radius) => column((s) => Math.PI / 2 + s / radius);
    const message = {
      known,
      because: known ? "" : "the bit is off bottom",
      window: 5,
      turns: 3,
      measured_depth: bit,
      weight_on_bit: 1e4,
      build_rate: 1 / radius,
      build_rate_low: 1 / 3.7,
      build_rate_high: 1 / 3.4,
      radius,
      radius_low: 3.4,
      radius_high: 3.7,
      steering_number: 0.95,
      free_length: 1.1,
      ripples: true,
      radius_any_bit_low: 2.81,
      radius_any_bit_high: 3.65,
      measured_depths: column((s) => bit + s),
      inclinations: inclination(radius),
      inclinations_low: inclination(3.9),
      inclinations_high: inclination(3.3),
      azimuths: column(() => 0),
      azimuths_low: column((s) => -0.01 * s),
      azimuths_high: column((s) => 0.01 * s),
      position_x: column((s) => 3.2 + radius * Math.sin(s / radius)),
      position_y: column((s) => 0.002 * s * s),
      position_z: column((s) => 3.2 - radius * (1 - Math.cos(s / radius))),
      half_width_high: column((s) => 0.012 * s * s),
      half_width_right: column((s) => 0.006 * s * s),
      members: 100,
      failed: 0,
      surveys_used: 0,
      since_survey: NaN,
    };
    const station = (measured_depth, inclination) => ({ measured_depth, inclination, azimuth: 0.5 });
    const plan = {
      target: 0.1,
      file: null,
      stations: [station(0, 0), station(bit, Math.PI / 2), station(bit + 4, Math.PI / 2 + 4 / 3.2)],
    };
    const put = () => {
      const sec = Math.floor(store.now);
      if (store.session?.tool) store.session.tool.plan = plan;
      store.accept("twin/hole_ahead", { ...message, header: { stamp: { sec, nanosec: 0 }, frame_id: "tool" } });
    };
    store.take = (topic, ...more) => {
      if (topic !== "twin/hole_ahead") Object.getPrototypeOf(store).take.call(store, topic, ...more);
    };
    clearInterval(window.holeTimer);
    window.holeTimer = setInterval(put, 1000);
    put();
  }, known);
}

/** Takes them away again. */
export async function restore(page) {
  await page.evaluate(() => {
    const { store } = window.flexdrill;
    clearInterval(window.holeTimer);
    delete window.holeTimer;
    delete store.take;
    if (store.session?.tool) store.session.tool.plan = null;
    store.hole = null;
  });
}
