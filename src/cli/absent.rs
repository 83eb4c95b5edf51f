//! Commands that this build lacks. They are listed like the others, and each names the feature that brings it.

/// Why a part of the program is refused: this build lacks it.
pub(super) fn refusal(what: &str, feature: &str) -> anyhow::Error {
    anyhow::anyhow!(
        "this flexdrill was built without {what}; build it with the feature {feature}: cargo build --release --features \
         {feature} (the feature full has everything)"
    )
}

/// Commands by module, arguments, name, feature, and what `run` takes in addition to the arguments.
macro_rules! absent {
    ($($module:ident, $args:ident, $command:literal, $feature:literal $(, $more:ty)?;)*) => {$(
        #[cfg(not(feature = $feature))]
        pub(super) mod $module {
            /// The arguments, which have no meaning in this build.
            #[derive(Debug, clap::Args)]
            #[command(about = concat!("Not in this build: the feature ", $feature, " brings it"), disable_help_flag = true)]
            pub(in crate::cli) struct $args {
                #[arg(hide = true, trailing_var_arg = true, allow_hyphen_values = true)]
                _arguments: Vec<std::ffi::OsString>,
            }

            /// # Errors
            /// Always: this build lacks the command.
            pub(in crate::cli) fn run(_args: &$args $(, _more: $more)?) -> anyhow::Result<()> {
                Err(super::refusal(concat!("`flexdrill ", $command, "`"), $feature))
            }
        }
    )*};
}

absent! {
    ahead, AheadArgs, "ahead", "sweep";
    bench, BenchArgs, "bench", "bench";
    bridge, BridgeArgs, "bridge", "bridge", &[String];
    calibrate, CalibrateArgs, "calibrate", "calibrate";
    map, MapArgs, "map", "sweep";
    paper, PaperArgs, "paper", "paper";
    reach, ReachArgs, "reach", "sweep";
    report, ReportArgs, "report", "report";
    sensitivity, SensitivityArgs, "sensitivity", "sweep";
    sweep, SweepArgs, "sweep", "sweep";
    trip, TripArgs, "trip", "sweep";
}
