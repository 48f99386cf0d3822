//! Which composites the cells and sides are in.

use rustc_hash::FxHashMap;

use super::fault::NektarFault;
use super::shape;
use super::tables::{Listed, Tables};

/// Places among the composites, of each cell and side that is in some.
#[derive(Default)]
pub(super) struct Membership {
    /// By the cell's place.
    pub(super) cells: FxHashMap<usize, Vec<usize>>,
    /// By the side's place, in the order in which composites name them.
    pub(super) sides: Vec<(usize, Vec<usize>)>,
    /// Composites of vertices, or in 3D of edges, which have no place here.
    pub(super) lower: usize,
}

/// The lowest number of composites of a name that hold cells, or sides.
pub(super) fn lowest(tables: &Tables, name: &str, of_cells: bool) -> Option<i64> {
    let is = |own: &&Listed| {
        let letter = own.members.trim_start().chars().next().unwrap_or(' ');
        let holds_cells = matches!(kind(tables.dimension, letter), Some(Kind::Cells));
        own.name.as_deref() == Some(name) && holds_cells == of_cells
    };
    tables.composites.iter().filter(is).map(|own| own.id).min()
}

/// What the letters of a composite mean.
enum Kind {
    Cells,
    Sides,
    Lower,
}

impl Membership {
    /// Reads the composites; `cells` and `sides` tell the places of the numbers in files.
    ///
    /// # Errors
    /// A composite that is no list, or that names what there is not.
    pub(super) fn of(
        tables: &Tables,
        cells: &FxHashMap<i64, usize>,
        sides: &FxHashMap<i64, usize>,
    ) -> Result<Membership, NektarFault> {
        let mut own = Membership::default();
        let mut by_side: FxHashMap<usize, usize> = FxHashMap::default();
        for (place, composite) in tables.composites.iter().enumerate() {
            let mut is_lower = false;
            for (letter, [first, last]) in members(composite)? {
                let (known, what) = match kind(tables.dimension, letter) {
                    None => return Err(unread(composite)),
                    Some(Kind::Lower) => {
                        is_lower = true;
                        continue;
                    }
                    Some(Kind::Cells) => (cells, true),
                    Some(Kind::Sides) => (sides, false),
                };
                for number in first..=last {
                    let Some(&at) = known.get(&number) else {
                        let what = if what { "element" } else { "side" };
                        return Err(NektarFault::Unknown {
                            section: "COMPOSITE",
                            id: composite.id,
                            what,
                            wrong: number,
                        });
                    };
                    let list = if what {
                        own.cells.entry(at).or_default()
                    } else {
                        let slot = *by_side.entry(at).or_insert_with(|| {
                            own.sides.push((at, Vec::new()));
                            own.sides.len() - 1
                        });
                        &mut own.sides[slot].1
                    };
                    if list.last() != Some(&place) {
                        list.push(place);
                    }
                }
            }
            own.lower += usize::from(is_lower);
        }
        Ok(own)
    }
}

fn kind(dimension: usize, letter: char) -> Option<Kind> {
    let mut word = [0; 4];
    let own = shape::lettered(letter.encode_utf8(&mut word)).map(|shape| shape.cell.dimension());
    match (letter, own) {
        ('V', _) => Some(Kind::Lower),
        ('E' | 'S', _) if dimension == 2 => Some(Kind::Sides),
        ('E' | 'S', _) => Some(Kind::Lower),
        ('F', _) if dimension == 3 => Some(Kind::Sides),
        ('F', _) => Some(Kind::Cells),
        (_, Some(own)) if own == dimension => Some(Kind::Cells),
        (_, Some(own)) if own + 1 == dimension => Some(Kind::Sides),
        _ => None,
    }
}

fn unread(composite: &Listed) -> NektarFault {
    NektarFault::Composite { id: composite.id, found: composite.members.trim().chars().take(40).collect() }
}

/// Letters, and first and last of the numbers: `F[0-3,7] F[9]`.
fn members(composite: &Listed) -> Result<Vec<(char, [i64; 2])>, NektarFault> {
    let mut found = Vec::new();
    let mut rest = composite.members.trim();
    while !rest.is_empty() {
        let parsed = || {
            let letter = rest.chars().next().filter(char::is_ascii_uppercase)?;
            let (list, behind) = rest[1..].trim_start().strip_prefix('[')?.split_once(']')?;
            let ranges: Option<Vec<[i64; 2]>> = list.split(',').map(range).collect();
            Some((letter, ranges?, behind.trim_start_matches([',', ' ', '\n', '\r', '\t'])))
        };
        let (letter, ranges, behind) = parsed().ok_or_else(|| unread(composite))?;
        found.extend(ranges.into_iter().map(|range| (letter, range)));
        rest = behind;
    }
    Ok(found)
}

fn range(text: &str) -> Option<[i64; 2]> {
    let (first, last) = text.split_once('-').unwrap_or((text, text));
    let [first, last] = [first, last].map(|word| word.trim().parse::<u32>().ok().map(i64::from));
    Some([first?, last?]).filter(|[first, last]| first <= last)
}
