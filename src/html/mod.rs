//! A report as one page for a browser: all figures of the JSON document, and the mesh in space. It loads nothing from anywhere; what a
//! large mesh has beyond about 17 MB is left out, and the page says so.
//!
//! The page holds the JSON document as it is, and makes all its figures from it (`figures.js`), so that none can differ. The mesh is drawn
//! by WebGL 2 with three.js (`vendor/`, made by `make vendor-three`) in `view.js`.

mod geometry;

use std::borrow::Cow;

use glam::DVec3;
use serde::Serialize;
use serde_json::Value;

use crate::mesh::{FaceKey, Mesh};
use crate::scene::{Measures, Surface};
use geometry::{Room, geometry};

/// Where the parts of the page go.
const PAGE: &str = include_str!("page.html");

/// The version of three.js that is built in.
pub const THREE: &str = "0.187.0";

/// What a page is made of.
#[derive(Debug)]
pub struct Page<'a> {
    /// The report.
    pub report: Value,
    /// The mesh that it is of.
    pub mesh: &'a Mesh,
    /// The measures of its elements.
    pub measures: &'a Measures,
}

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
#[error("the report cannot be made a page: {0}")]
pub struct NoPage(#[from] serde_json::Error);

impl<'a> Page<'a> {
    /// A page of a document.
    ///
    /// # Errors
    /// [`NoPage`]: the document is no JSON.
    pub fn new(report: &impl Serialize, mesh: &'a Mesh, measures: &'a Measures) -> Result<Page<'a>, NoPage> {
        Ok(Page { report: serde_json::to_value(report)?, mesh, measures })
    }

    /// The page as text; `distance` tells how far a boundary face is from the CAD, by its corners, where that is known.
    ///
    /// # Errors
    /// [`NoPage`].
    pub fn text(&self, distance: impl Fn(FaceKey) -> Option<f64>) -> Result<String, NoPage> {
        self.text_within(Room::PAGE, distance)
    }

    /// The page whose geometry has this room.
    fn text_within(&self, room: Room, distance: impl Fn(FaceKey) -> Option<f64>) -> Result<String, NoPage> {
        let surface = Surface::of(self.mesh);
        let of = |face: &crate::scene::Shown| distance(FaceKey::new(&face.nodes[..face.cell.corner_count()]));
        let distances: Vec<f64> = surface.faces.iter().map(|face| of(face).unwrap_or(f64::NAN)).collect();
        let geometry = geometry(self.mesh, &surface, self.measures, &distances, &self.places(), room);
        let script =
            format!("{}\n{}", include_str!("figures.js"), include_str!("view.js").replacen("\"use strict\";", "", 1));
        let parts: [(&str, Cow<str>); 5] = [
            ("@@STYLE@@", include_str!("page.css").into()),
            ("@@REPORT@@", embedded(&serde_json::to_string(&self.report)?).into()),
            ("@@GEOMETRY@@", embedded(&serde_json::to_string(&geometry)?).into()),
            ("@@THREE@@", include_str!("vendor/three.min.js").into()),
            ("@@SCRIPT@@", script.into()),
        ];
        let mut text = String::new();
        let mut rest = PAGE;
        for (place, part) in &parts {
            let (before, after) = rest.split_once(place).unwrap_or((rest, ""));
            text += before;
            text += part;
            rest = after;
        }
        Ok(text + rest)
    }

    /// The places of the elements to look at first.
    fn places(&self) -> Vec<DVec3> {
        let low = self.report.get("lowest").and_then(Value::as_array).into_iter().flatten();
        let place = |low: &Value| {
            let own: Vec<f64> = low.get("position")?.as_array()?.iter().filter_map(Value::as_f64).collect();
            <[f64; 3]>::try_from(own).ok().map(DVec3::from)
        };
        low.filter_map(place).collect()
    }
}

/// JSON that ends no script, whatever names stand in it.
fn embedded(json: &str) -> String {
    json.replace('<', "\\u003c")
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// What a page has beyond its geometry: the library, the report, and the names in the geometry.
    #[test]
    fn a_page_has_no_more_than_its_room_and_says_what_it_leaves_out() {
        let mesh = crate::formats::read(std::path::Path::new("fixtures/weeble/weeble.msh")).unwrap();
        let measures = Measures::default();
        let page = Page::new(&serde_json::json!({"lowest": []}), &mesh, &measures).unwrap();
        let length = |faces, elements| page.text_within(Room { faces, elements }, |_| None).unwrap().len();
        let (none, whole) = (length(1, 1), length(1 << 30, 1 << 30));
        for (faces, elements) in [(10_000, 50_000), (20_000, 400_000)] {
            let room = Room { faces, elements };
            let text = page.text_within(room, |_| None).unwrap();
            let most = none + (faces + elements) * 4 / 3 + 2000;
            assert!(text.len() < most && most < whole, "{} bytes of {whole}, at most {most}", text.len());
            assert!(
                text.contains(" of 674 boundary faces: one of every ")
                    && text.contains(" of 28242 elements that can be cut")
            );
        }
    }

    #[test]
    fn the_page_has_a_place_for_each_part_and_the_parts_end_no_script() {
        let places = ["@@STYLE@@", "@@REPORT@@", "@@GEOMETRY@@", "@@THREE@@", "@@SCRIPT@@"];
        let found: Vec<_> = places.iter().map(|place| PAGE.find(place)).collect();
        assert!(found.is_sorted() && found.iter().all(Option::is_some), "{found:?}");
        for script in [include_str!("vendor/three.min.js"), include_str!("figures.js"), include_str!("view.js")] {
            assert!(!script.contains("</script"));
        }
        assert_eq!(embedded("{\"name\":\"</script>\"}"), "{\"name\":\"\\u003c/script>\"}");
    }
}
