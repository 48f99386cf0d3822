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

/// The last lines: what is proven of the elements.
fn certificate(certificate: &CertificateReport, certified: bool, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    if certified {
        if let Some(weakest) = certificate.worst.first() {
            let (cell, number, at) = (weakest.cell, weakest.element, position(weakest.position));
            writeln!(f, "weakest element: {cell} {number} near {at}")?;
        }
        let bounds = certificate.j_over_jc;
        let (lower, upper) = (number(bounds.lower), number(bounds.upper));
        return write!(f, "certified: every element valid, J/Jc >= {lower} everywhere (attained: {upper})");
    }
    write!(f, "NOT certified: {} elements are not proven valid", certificate.failures().count())?;
    for element in certificate.failures().take(LISTED) {
        let (verdict, cell, number) = (element.verdict.name(), element.cell, element.element);
        write!(f, "\n  {verdict} {cell} {number} near {}", position(element.position))?;
    }
    Ok(())
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
