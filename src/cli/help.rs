//! What stands below the long help of every command: examples, and its exit codes; and the headings of options.

use super::exit::{COULD_NOT_RUN, DONE, INTERRUPTED, NOT_CERTIFIED, SIDE_FILE, meaning};
#[cfg(feature = "cad")]
use super::exit::{FINDINGS, OFF_CAD, STOPPED};

/// Headings of options: what goes in, what is to be curved, how good it is to be, what comes out, how it is run, what few need.
pub(super) const INPUT: &str = "Input";
#[cfg(feature = "cad")]
pub(super) const WHAT: &str = "What to curve";
#[cfg(feature = "cad")]
pub(super) const QUALITY: &str = "Quality";
pub(super) const OUTPUT: &str = "Output";
#[cfg(feature = "cad")]
pub(super) const RUN: &str = "Run";
#[cfg(feature = "cad")]
pub(super) const EXPERT: &str = "Expert";

/// Below the short help.
pub(super) fn short() -> &'static str {
    "-h is short; --help has all options, examples and exit codes."
}

/// Of the program.
#[cfg(feature = "cad")]
pub(super) fn program() -> String {
    let examples = "
  sagitta curve fixtures/weeble/weeble.msh --cad fixtures/weeble/weeble.step \\
      --order 3 -o weeble_p3.msh
  sagitta check weeble_p3.msh --linear fixtures/weeble/weeble.msh";
    let codes = [DONE, FINDINGS, COULD_NOT_RUN, OFF_CAD, NOT_CERTIFIED, STOPPED, SIDE_FILE];
    format!("{}\n\n`sagitta COMMAND --help` has examples of each command.", below(examples, &codes))
}

/// Of the program without CAD.
#[cfg(not(feature = "cad"))]
pub(super) fn program() -> String {
    let examples = "
  sagitta check weeble_p3.msh --linear fixtures/weeble/weeble.msh
  sagitta convert weeble_p3.msh -o weeble_p3.cgns";
    below(examples, &[DONE, COULD_NOT_RUN, NOT_CERTIFIED, SIDE_FILE])
}

#[cfg(feature = "cad")]
pub(super) fn curve() -> String {
    let examples = "
  sagitta curve fixtures/weeble/weeble.msh --cad fixtures/weeble/weeble.step \\
      --order 3 -o weeble_p3.msh
  sagitta curve fixtures/weeble/weeble.msh --cad fixtures/weeble/weeble.step \\
      --linkage fixtures/weeble/weeble.meshlink.xml --order 2 \\
      -o weeble_p2.vtu --report weeble_p2.json --html weeble_p2.html
  sagitta curve fixtures/naca0012_sharp/naca0012_sharp.msh \\
      --cad fixtures/naca0012_sharp/naca0012_sharp.step --order 3 \\
      -o naca_p3.msh -o naca_p3.vtm";
    below(examples, &[DONE, COULD_NOT_RUN, OFF_CAD, NOT_CERTIFIED, STOPPED, SIDE_FILE])
}

pub(super) fn check() -> String {
    let examples = "
  sagitta check fixtures/samples/hexpyrtet_p3_msh41a.msh
  sagitta check weeble_p3.msh --linear fixtures/weeble/weeble.msh \\
      --report weeble_check.json --html weeble_check.html
  sagitta check weeble_p3.msh --fields weeble_fields.vtu
  sagitta check fixtures/weeble/weeble.msh --cad fixtures/weeble/weeble.step \\
      --order 3";
    below(examples, &[DONE, COULD_NOT_RUN, NOT_CERTIFIED, SIDE_FILE])
}

pub(super) fn convert() -> String {
    let examples = "
  sagitta convert fixtures/weeble/weeble.msh -o weeble.cgns
  sagitta convert weeble_p3.msh --volume-only -o weeble_p3.vtu";
    below(examples, &[DONE, COULD_NOT_RUN, SIDE_FILE])
}

#[cfg(feature = "cad")]
pub(super) fn spline() -> String {
    let examples = "
  sagitta spline fixtures/airfoils/naca2412.dat -o naca2412.step";
    below(examples, &[DONE, COULD_NOT_RUN, SIDE_FILE])
}

#[cfg(feature = "cad")]
pub(super) fn link() -> String {
    let examples = "
  sagitta link fixtures/weeble/weeble.msh --cad fixtures/weeble/weeble.step \\
      -o weeble_link.xml
  sagitta link fixtures/torus/torus.msh --cad fixtures/torus/torus.step \\
      --ignore-tags -o torus_link.xml --report torus_link.json";
    below(examples, &[DONE, COULD_NOT_RUN, SIDE_FILE])
}

#[cfg(feature = "cad")]
pub(super) fn validate() -> String {
    let examples = "
  sagitta validate fixtures/weeble/weeble.meshlink.xml
  sagitta validate fixtures/weeble/weeble.meshlink.xml \\
      --mesh fixtures/weeble/weeble.msh --cad fixtures/weeble/weeble.step";
    below(examples, &[DONE, FINDINGS, COULD_NOT_RUN])
}

pub(super) fn explain() -> String {
    let examples = "
  sagitta explain
  sagitta explain ML503";
    below(examples, &[DONE, COULD_NOT_RUN])
}

pub(super) fn info() -> String {
    let examples = "
  sagitta info fixtures/weeble/weeble.msh
  sagitta info fixtures/weeble/weeble.meshlink.xml";
    below(examples, &[DONE, COULD_NOT_RUN])
}

pub(super) fn completions() -> String {
    let examples = "
  sagitta completions bash
  sagitta completions zsh";
    below(examples, &[DONE, COULD_NOT_RUN])
}

pub(super) fn man() -> String {
    below("\n  mkdir -p man && sagitta man man && man -l man/sagitta-curve.1", &[DONE, COULD_NOT_RUN])
}

pub(super) fn report() -> String {
    let examples = "
  sagitta report weeble_p2.json weeble_p2.vtu -o weeble_p2.html
  sagitta report weeble_check.json weeble_p3.msh \\
      --linear fixtures/weeble/weeble.msh -o weeble_p3.html";
    below(examples, &[DONE, COULD_NOT_RUN, SIDE_FILE])
}

pub(super) fn picture() -> String {
    let examples = "
  sagitta picture fixtures/samples/hexpyrtet_p3_msh41a.msh -o boundary.png
  sagitta picture fixtures/weeble/weeble.msh --color patch -o patches.png
  sagitta picture weeble_p3.msh --cut y:0 --view -y --worst 5 -o worst.png";
    below(examples, &[DONE, COULD_NOT_RUN, SIDE_FILE])
}

#[cfg(feature = "cad")]
pub(super) fn groups() -> String {
    let examples = "
  sagitta groups fixtures/weeble/weeble.step
  sagitta groups fixtures/cylinder_bl/cylinder_bl.igs --json";
    below(examples, &[DONE, COULD_NOT_RUN])
}

#[cfg(feature = "cad")]
pub(super) fn project() -> String {
    let examples = "
  sagitta project fixtures/weeble/weeble.step fixtures/samples/points.csv
  sagitta project fixtures/weeble/weeble.step fixtures/samples/points.csv \\
      --group face:2,face:3 -o feet.csv --report feet.json";
    below(examples, &[DONE, COULD_NOT_RUN, NOT_CERTIFIED, SIDE_FILE])
}

/// Lines of 80 columns at most: clap breaks longer ones on a narrow terminal, where they can no longer be pasted.
fn below(examples: &str, codes: &[u8]) -> String {
    let codes = codes.iter().chain(&[INTERRUPTED]);
    let codes: Vec<String> = codes.map(|&code| format!("  {code:<3}  {}", meaning(code))).collect();
    format!("Examples:{examples}\n\nExit codes:\n{}", codes.join("\n"))
}
