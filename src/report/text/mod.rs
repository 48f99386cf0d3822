//! Reports as text for people: what several have in common.

#[cfg(feature = "cad")]
mod association;
mod check;
#[cfg(feature = "cad")]
mod curve;
#[cfg(feature = "cad")]
mod feet;
#[cfg(feature = "cad")]
mod groups;

use std::fmt::{self, Display};

use super::certificate::CertificateReport;

/// Items of a list that are printed; the JSON document has all.
const LISTED: usize = 10;

/// Columns that tables have at most.
#[cfg(feature = "cad")]
const WIDTH: usize = 80;

/// The first lines: what is proven of the elements, and which is the worst.
fn certificate(certificate: &CertificateReport, certified: bool, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    let bounds = certificate.j_over_jc;
    let (lower, upper) = (number(bounds.lower), number(bounds.upper));
    if certified {
        writeln!(f, "certified: every element valid, J/Jc >= {lower} everywhere (attained: {upper})")?;
        let Some(weakest) = certificate.worst.first() else { return Ok(()) };
        let (cell, number, at) = (weakest.cell, weakest.element, position(weakest.position));
        return writeln!(f, "worst element: {cell} {number} near {at}");
    }
    writeln!(f, "NOT certified: {} elements are not proven valid", certificate.failures().count())?;
    for element in certificate.failures().take(LISTED) {
        let (verdict, cell, number) = (element.verdict.name(), element.cell, element.element);
        writeln!(f, "  {verdict} {cell} {number} near {}", position(element.position))?;
    }
    more(certificate.failures().count(), f)
}

/// How many of a list are not printed.
fn more(count: usize, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    let more = count.saturating_sub(LISTED);
    if more == 0 { Ok(()) } else { writeln!(f, "  {more} more (--report lists them)") }
}

/// A row of a table of patches: name, figures, and what of the CAD it lies on. What does not fit into the line stands below.
#[cfg(feature = "cad")]
fn patch_row(name: &str, figures: &str, on: &[String], f: &mut fmt::Formatter<'_>) -> fmt::Result {
    const NAME: usize = 24;
    let line =
        if name.len() < NAME { format!("{name:<NAME$}{figures}") } else { format!("{name}\n{:NAME$}{figures}", "") };
    let whole = on.join("; ");
    if on.is_empty() {
        return writeln!(f, "{line}  none");
    }
    if NAME + figures.len() + 2 + whole.len() <= WIDTH {
        return writeln!(f, "{line}  {whole}");
    }
    let mut listed = format!("    on {}", on[0]);
    for (n, item) in on.iter().enumerate().skip(1) {
        let rest = format!(" and {} more (--report lists them)", on.len() - n);
        if listed.len() + 2 + item.len() + rest.len() > WIDTH {
            listed += &rest;
            break;
        }
        listed += &format!("; {item}");
    }
    writeln!(f, "{line}\n{listed}")
}

/// A number of four decimals, or a dash.
fn number(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.4}"))
}

/// `(x, y, z)`.
fn position(at: [f64; 3]) -> impl Display {
    let [x, y, z] = at;
    format!("({x:.6}, {y:.6}, {z:.6})")
}

/// A patch by its names and its entity.
#[cfg(feature = "cad")]
fn patch(names: &[String], entity: &str) -> String {
    if names.is_empty() { entity.to_owned() } else { format!("{} {entity}", names.join(",")) }
}
