// Lists of alarms that the page is looked at with: what a twin publishes only in trouble is put in place of its own.

/** Priorities and states of msg/Alarm.msg. */
const [LOW, MEDIUM, HIGH] = [1, 2, 3];
const [UNACKNOWLEDGED, ACKNOWLEDGED] = [1, 2];

/** Alarms of the computer, with texts as long as the node's. */
const SYSTEM = [
  {
    id: "real_time",
    priority: MEDIUM,
    state: UNACKNOWLEDGED,
    evidence: "The model gained 0.72 s of model time per second over the last ten seconds.",
    cause: "Other programs use the processor, or the model is larger than this computer can compute in time.",
    consequence: "The values that are shown fall behind the rig.",
    what_to_do: "Rely on the rig's own instruments and call the engineer.",
    what_the_engineer_can_do:
      "End other programs on this computer, give the node the cores that the guide to deployment names, or choose a " +
      "coarser configuration of the tool; the report of flexdrill bench says what this computer can do.",
  },
  {
    id: "recording",
    priority: MEDIUM,
    state: UNACKNOWLEDGED,
    evidence: "Writing failed 3 times within the last 30 s; 412 messages were lost.",
    cause: "The disk is full.",
    consequence: "The recording has gaps: what happens now cannot be looked at later.",
    what_to_do: "Call the engineer.",
    what_the_engineer_can_do:
      "Free space on the disk of the recordings, or name another folder for them; the node goes on with a new file " +
      "within 30 s.",
  },
];

const FOLLOW = "Follow the advice for backward whirl first, then check this alarm again.";
const OVER = "No further action: the alarm clears by itself unless the motion returns.";

/** Alarms of the tool's motion: the first of the published list and another have ended, three conditions are met. */
const MOTION = [
  {
    id: "stick_slip",
    priority: HIGH,
    state: UNACKNOWLEDGED,
    ended: true,
    evidence:
      "The bit stops and spins back: its speed swings between -12 and 210 r/min. Ended at 07:08:34, being watched.",
    cause: "Torque at the bit winds up the string until the bit breaks free.",
    consequence: "Cutters break when the bit spins back; connections loosen.",
    what_to_do: OVER,
  },
  {
    id: "chaotic_whirl",
    priority: HIGH,
    state: UNACKNOWLEDGED,
    body: 1,
    measured_depth: 2.25,
    inclination: 0.6,
    evidence: "Chaotic motion of the pipe, collisions dissipate 38 W/m over 61 % of its length.",
    cause: "Backward whirl and impacts disturb each other.",
    consequence: "Joints and guide wear within hours.",
    what_to_do: FOLLOW,
  },
  {
    id: "shock",
    priority: MEDIUM,
    state: UNACKNOWLEDGED,
    ended: true,
    evidence: "Collisions of the guide with up to 9.4 N s. Ended at 07:08:40, being watched.",
    cause: "The guide strikes the wall.",
    consequence: "Slots of the guide crack.",
    what_to_do: OVER,
  },
  {
    id: "forward_whirl",
    priority: MEDIUM,
    state: ACKNOWLEDGED,
    evidence: "Forward whirl with a friction power of 345 W/m.",
    cause: "Friction between pipe and guide.",
    consequence: "The pipe wears on one side.",
    what_to_do: FOLLOW,
  },
  {
    id: "backward_whirl",
    priority: HIGH,
    state: UNACKNOWLEDGED,
    body: 1,
    measured_depth: 1.5,
    inclination: 0.47,
    evidence: "Backward whirl of the pipe at 1.50 m (27 deg), sliding, whirl rate 2.4 times the rotary speed.",
    cause: "Friction drives the pipe round the guide against the rotation.",
    consequence: "Each link bends 3.4 times per turn; joint fatigue.",
    what_to_do:
      "Lower the speed below 80 r/min (120 r/min now) and keep the weight on bit. If it persists, pick up off bottom " +
      "and stop the drive.",
  },
];

export const STATES = { no_alarm: [], two_of_the_system: SYSTEM, five_of_motion: MOTION, all: [...MOTION, ...SYSTEM] };

/** Puts these alarms in place of the twin's own, until `restore`. */
export async function impose(page, alarms) {
  await page.evaluate((alarms) => {
    const { store } = window.flexdrill;
    const before = (store.imposed ??= { list: store.alarms, take: store.take });
    const time = store.now;
    const at = { sec: Math.floor(time), nanosec: 0 };
    const never = { sec: 0, nanosec: 0 };
    const known = new Map(before.list.alarms.map((alarm) => [alarm.id, alarm]));
    const first = alarms.map((over) => {
      const since = { sec: at.sec - 75, nanosec: 0 };
      const ended_at = over.ended ? { sec: at.sec - 4, nanosec: 0 } : never;
      const where = { body: 0, measured_depth: NaN, inclination: NaN };
      return {
        ...known.get(over.id),
        active: true,
        acknowledged: over.state === 2,
        since,
        worst_at: since,
        ended_at,
        ...where,
        ...over,
      };
    });
    const normal = { state: 0, priority: 0, active: false, ended: false, evidence: "", what_to_do: "" };
    const rest = before.list.alarms
      .filter((alarm) => !first.some((one) => one.id === alarm.id))
      .map((alarm) => ({ ...alarm, ...normal }));
    const sequence =
      (store.alarms?.sequence ?? before.list.sequence) + (typeof before.list.sequence === "bigint" ? 1n : 1);
    const list = {
      ...before.list,
      header: { ...before.list.header, stamp: at },
      sequence,
      alarms: [...first, ...rest],
      unacknowledged: first.filter((alarm) => alarm.state === 1).length,
    };
    store.take = (topic, ...more) => {
      if (topic !== "twin/alarms") before.take.call(store, topic, ...more);
    };
    store.accept("twin/alarms", list);
  }, alarms);
}

/** Lets the twin's own alarms through again. */
export async function restore(page) {
  await page.evaluate(() => {
    const { store } = window.flexdrill;
    if (!store.imposed) return;
    delete store.take;
    store.accept("twin/alarms", { ...store.imposed.list, sequence: store.alarms.sequence });
    delete store.imposed;
  });
}
