//! What stands below the help of every command.

// Narrow, as clap breaks longer lines on an 80-column terminal, where they can no longer be pasted.
#[cfg(feature = "cad")]
pub(super) const EXAMPLES: &str = "\
Examples:
  sagitta curve fixtures/weeble/weeble.msh --cad fixtures/weeble/weeble.step \\
      --order 3 -o weeble_p3.msh
  sagitta curve fixtures/weeble/weeble.msh --cad fixtures/weeble/weeble.step \\
      --linkage fixtures/weeble/weeble.meshlink.xml --order 2 \\
      -o weeble_p2.vtu --report weeble_p2.json
  sagitta check weeble_p3.msh --linear fixtures/weeble/weeble.msh
  sagitta link fixtures/weeble/weeble.msh --cad fixtures/weeble/weeble.step \\
      -o weeble_link.xml
  sagitta validate fixtures/weeble/weeble.meshlink.xml \\
      --mesh fixtures/weeble/weeble.msh --cad fixtures/weeble/weeble.step
  sagitta explain ML503
  sagitta info fixtures/weeble/weeble.step
  sagitta groups fixtures/weeble/weeble.step
  sagitta project fixtures/weeble/weeble.step fixtures/samples/points.csv \\
      --group face:2,face:3 -o feet.csv --report feet.json
  sagitta convert weeble_p3.msh -o weeble_p3.cgns

Exit codes: 0 done and certified, or clean; 1 findings (validate only);
2 could not run; 3 certified with some faces not on the CAD; 4 not certified
(project: some feet not proven to be the closest); 5 stopped early but certified.";

/// Without the commands that need CAD.
#[cfg(not(feature = "cad"))]
pub(super) const EXAMPLES: &str = "\
Examples:
  sagitta check weeble_p3.msh --linear fixtures/weeble/weeble.msh
  sagitta explain ML503
  sagitta info fixtures/weeble/weeble.msh
  sagitta convert weeble_p3.msh -o weeble_p3.cgns

Exit codes: 0 done, and valid; 2 could not run; 4 not certified.";
