//! The help that both programs print.

/// The help of a program: what it does, two examples, and then its options.
macro_rules! help_template {
    ($first:literal, $second:literal) => {
        concat!(
            "{before-help}{about-with-newline}\nExamples:\n  ",
            $first,
            "\n  ",
            $second,
            "\n\n{usage-heading} {usage}\n\n{all-args}{after-help}"
        )
    };
}
pub(super) use help_template;
