//! `sagitta picture`.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::{form, input, signals};
use crate::cli::exit::DONE;
use crate::cli::files::Files;
use crate::cli::output::{Beside, Failure, print};
use crate::formats;
use crate::picture::{self, Colouring, PIXELS, Settings, VIEWS, View};
use crate::scene::{Axis, CutPlane};

/// Options of `sagitta picture`.
#[derive(Args)]
pub(super) struct Options {
    #[arg(help = form::mesh("A mesh of order 1 to 4"))]
    mesh: PathBuf,
    /// The picture to write
    #[arg(short, long, value_name = "OUT.png", value_parser = png_name)]
    output: PathBuf,
    /// From where: iso is from the front, the right and above; x from the end of the x axis [default: iso, a plane mesh along its normal]
    #[arg(long, value_name = "VIEW", value_parser = PossibleValuesParser::new(VIEWS), allow_hyphen_values = true)]
    view: Option<String>,
    /// What colours say
    #[arg(long, value_name = "WHAT", value_enum, default_value_t)]
    color: Colouring,
    /// CutPlane the volume by the plane on which this coordinate has this value, as z:0.25; what is before it is left out
    #[arg(long, value_name = "x|y|z:VALUE", value_parser = cut, allow_hyphen_values = true)]
    cut: Option<CutPlane>,
    /// Mark and list so many of the elements with the smallest J/J_c
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u64).range(0..=50))]
    worst: u64,
    /// Show these patches: physical names or surface numbers [default: all but those that stand far round the others]
    #[arg(long, value_name = "PATCH,...", value_delimiter = ',')]
    patch: Vec<String>,
    /// The linear mesh that it was made from: the reference of J/J_c [default: each element's own corners]
    #[arg(long, value_name = "P1MESH")]
    linear: Option<PathBuf>,
    /// Pixels across and down
    #[arg(long, value_name = "WxH", default_value = "1200x900", value_parser = size)]
    size: [usize; 2],
    #[cfg(feature = "cad")]
    #[command(flatten)]
    cad: super::with_cad::CadFile,
}

/// A picture's name.
fn png_name(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let is_png = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png"));
    if is_png { Ok(path) } else { Err(format!("{text:?} does not end in .png, and pictures are PNG files")) }
}

/// A plane that cuts.
fn cut(text: &str) -> Result<CutPlane, String> {
    let wrong = || format!("{text:?} is no plane: give an axis and a value, as z:0.25");
    let (axis, value) = text.split_once([':', '=']).ok_or_else(wrong)?;
    let axis = Axis::of(axis).ok_or_else(wrong)?;
    let at = value.parse::<f64>().ok().filter(|value| value.is_finite()).ok_or_else(wrong)?;
    Ok(CutPlane { axis, at })
}

/// Pixels across and down.
fn size(text: &str) -> Result<[usize; 2], String> {
    let [least, most] = PIXELS;
    let wrong = || format!("{text:?} is no size from {least}x{least} to {most}x{most} pixels, as 1200x900");
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(wrong)?;
    let pixels = |number: &str| number.parse::<usize>().ok().filter(|number| (least..=most).contains(number));
    Ok([pixels(width).ok_or_else(wrong)?, pixels(height).ok_or_else(wrong)?])
}

impl Options {
    fn settings(&self) -> Settings {
        Settings {
            view: self.view.as_deref().and_then(View::of),
            colouring: self.color,
            cut: self.cut,
            worst: usize::try_from(self.worst).unwrap_or_default(),
            size: self.size,
            patches: self.patch.clone(),
        }
    }

    fn files(&self) -> Files {
        let files =
            Files::of_mesh(&self.mesh).reads("--linear", self.linear.as_ref()).writes("--output", Some(&self.output));
        #[cfg(feature = "cad")]
        let files = self.cad.files(files);
        files
    }
}

/// Draws a mesh.
pub(super) fn run(options: &Options) -> Result<u8, Failure> {
    let name = options.mesh.display();
    options.files().check()?;
    if options.color == Colouring::Distance && !options.has_cad() {
        return Err(format!("{name}: its distance to the CAD needs the CAD: give --cad FILE").into());
    }
    let mesh = input::mesh(&options.mesh)?;
    if options.cut.is_some() && !mesh.is_volume() {
        return Err(format!("{name}: it has no volume that --cut could cut; leave --cut away").into());
    }
    let linear = input::linear_corners(&options.mesh, &mesh, options.linear.as_deref())?;
    let cells = mesh.cells().len();
    let stem = options.mesh.file_name().unwrap_or_default().to_string_lossy();
    let title = format!("{stem}: {}, {cells} elements", mesh.order());
    let settings = options.settings();
    #[cfg(feature = "cad")]
    let drawn = options
        .cad
        .with_distances(|distances| picture::draw(&mesh, linear.as_deref(), &title, &settings, distances))?;
    #[cfg(not(feature = "cad"))]
    let drawn = picture::draw(&mesh, linear.as_deref(), &title, &settings, None);
    let drawn = drawn.map_err(|cause| format!("{name}: {cause}"))?;
    signals::result_is(&options.output, DONE);
    formats::write_bytes(&options.output, &drawn.png)?;
    let mut text: String = drawn.worst.iter().map(|line| format!("{line}\n")).collect();
    if !drawn.left_out.is_empty() {
        text += &format!(
            "left out, as they stand far round the rest (--patch shows them): {}\n",
            drawn.left_out.join(", ")
        );
    }
    let mut beside = Beside::default();
    beside.tell(print(&format!("{text}written: {}", options.output.display())));
    Ok(beside.exit_code(DONE))
}

impl Options {
    #[cfg(feature = "cad")]
    fn has_cad(&self) -> bool {
        self.cad.is_given()
    }

    #[cfg(not(feature = "cad"))]
    #[allow(clippy::unused_self)]
    fn has_cad(&self) -> bool {
        false
    }
}

impl clap::ValueEnum for Colouring {
    fn value_variants<'a>() -> &'a [Colouring] {
        &[Colouring::Quality, Colouring::Scaled, Colouring::Distance, Colouring::Patch]
    }

    fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
        let (name, help) = match self {
            Colouring::Quality => ("quality", "proven lower bound of J/J_c of the element behind each face"),
            Colouring::Scaled => ("scaled", "proven lower bound of its scaled Jacobian"),
            Colouring::Distance => ("distance", "distance to the closest point of the CAD (--cad)"),
            Colouring::Patch => ("patch", "patches"),
        };
        Some(clap::builder::PossibleValue::new(name).help(help))
    }
}
