//! What the parameters mean that are words, flags, lists or counts, with the words that they take. All other numbers are
//! described by their unit and the reason of their limits.

/// A key, or the end of several keys that begins with a dot, and what it means.
const DESCRIPTIONS: &[(&str, &str)] = &[
    ("run.title", "What the configuration is for, in words."),
    (
        "tool.guide.fixed",
        "Whether every node of the guide pipe is held, as the outer beam of the paper's Fig. 8.",
    ),
    (
        "tool.joint.kind",
        "Kind of the joints: universal, ball_cage (constant velocity) or revolute (for comparison).",
    ),
    (
        "tool.joint.hinge_angle",
        "Of revolute joints: straight (links in line) or as_built (the well's bend stays in the pipe).",
    ),
    (
        "boundary.preset",
        "Supports at both ends: paper (its Table 1) or none (only boundary.supports).",
    ),
    (
        "boundary.bottom_axial",
        "The lower end along the axis: free (weight on bit moves it) or fixed.",
    ),
    (
        "boundary.wob_path",
        "What carries the weight on bit: guide, or shared (the pipe's lower end is tied to the guide's).",
    ),
    (
        "boundary.drive",
        "What turns the tool: top (the first node of the pipe) or none (as the supports say).",
    ),
    (
        "start",
        "State before the first step: static (at rest under gravity and weight on bit) or as_given (by initial).",
    ),
    (
        "initial.velocity",
        "With start: as_given, velocity of every node (m/s): along the axis, v and w across it.",
    ),
    (
        "initial.displacement",
        "With start: as_given, displacement of every node (m): along the axis, v and w across it.",
    ),
    (
        "shock.repeats.watch",
        "How many impulses beyond shock.levels.watch, within shock.span, reach that level.",
    ),
    (
        "shock.repeats.warning",
        "How many impulses beyond shock.levels.warning, within shock.span, reach that level.",
    ),
    (
        "shock.repeats.critical",
        "How many impulses beyond shock.levels.critical, within shock.span, reach that level.",
    ),
    (
        "solver.max_halvings",
        "How often a step is halved where Newton's iteration does not converge, before it fails.",
    ),
    (
        "solver.max_iterations",
        "Iterations of Newton's method in a step, before it is halved.",
    ),
    (
        "solver.step",
        "auto: the step is taken in parts as the motion asks for it and the pace allows it; fixed: whole.",
    ),
    ("tool.links", "Number of links."),
    ("tool.elements_per_link", "Number of beam elements of each link."),
    (
        "solver.scheme",
        "Time integration: newmark (the paper's), hht or generalised_alpha.",
    ),
    (
        "inputs.driver.policy",
        "Which publisher drives an input: newest (every one), first (until it is silent for max_age) or named.",
    ),
    (
        "network.reach",
        "How far DDS reaches: environment (as ROS 2's variables say), subnet or localhost.",
    ),
    (
        "whirl.watched",
        "Which places are watched for whirl, on both pipes: joints, all, or stations with a list of them.",
    ),
    (
        "whirl.watched.stations",
        "Stations that are watched for whirl, on both pipes; 0 is the uppermost.",
    ),
    (
        ".in_service",
        "Whether the alarm is in service; out of service it never calls.",
    ),
    (
        "outputs.frame_id",
        "Name of the tool's frame, in the header of every message: origin at the kick-off, Z down.",
    ),
    (
        "outputs.parent_frame",
        "Frame with Z up that /tf_static places the tool's frame in; empty: /tf_static is not sent.",
    ),
];

/// What a parameter means; `None` where the table does not have it.
pub(super) fn of(name: &str) -> Option<&'static str> {
    let matches = |key: &str| {
        if key.starts_with('.') {
            name.ends_with(key)
        } else {
            name == key
        }
    };
    DESCRIPTIONS
        .iter()
        .find(|(key, _)| matches(key))
        .map(|(_, description)| *description)
}
