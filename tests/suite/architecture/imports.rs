//! Which file of a crate imports something of which other: paths are followed to the file that defines the item.

use std::collections::BTreeSet;

use crate::architecture::source::{Module, Modules, Name};

/// One file needs another.
pub type Import = (Name, Name);

/// All imports of a crate. A parent that only hands on what its child defines (`pub use`) does not import it.
pub fn imports(modules: &Modules) -> BTreeSet<Import> {
    let mut found = BTreeSet::new();
    for (own, module) in modules {
        let used = |name: &String| !module.handed_on.contains(name) || module.mentions(name);
        let scope = module.scope.iter().filter(|(name, _)| used(name)).map(|(_, path)| path);
        let globs = module.globs.iter().filter(|path| !module.handed_on.contains(&path.join("::")));
        for (path, whole) in scope.chain(&module.paths).map(|path| (path, false)).chain(globs.map(|path| (path, true)))
        {
            let Some(path) = absolute(modules, own, module, path) else { continue };
            match home(modules, &path, 0) {
                // a module's name alone: what is taken of it stands in the paths that begin with it
                Home::Module(_) if !whole => {}
                Home::Module(target) | Home::Item(target) if target != *own => {
                    found.insert((own.clone(), target));
                }
                _ => {}
            }
        }
    }
    found
}

/// Where a path leads.
enum Home {
    Module(Name),
    /// An item of this module.
    Item(Name),
    Unknown,
}

/// A path as written in a module, from the crate's root; `None` for other crates and local names.
fn absolute(modules: &Modules, own: &Name, module: &Module, path: &[String]) -> Option<Name> {
    let (first, rest) = path.split_first()?;
    let mut base = own.clone();
    let mut rest = rest;
    match first.as_str() {
        "crate" => base.clear(),
        "self" => {}
        "super" => {
            base.pop();
            while let Some((next, behind)) = rest.split_first().filter(|(next, _)| *next == "super") {
                let _ = next;
                base.pop();
                rest = behind;
            }
        }
        _ => {
            let child = [own.as_slice(), std::slice::from_ref(first)].concat();
            if modules.contains_key(&child) {
                base = child;
            } else {
                let known = module.scope.get(first).filter(|known| known.as_slice() != path && known[0] != *first)?;
                base = absolute(modules, own, module, known)?;
            }
        }
    }
    base.extend(rest.iter().cloned());
    Some(base)
}

/// Follows a path, through what modules hand on, to where it is defined.
fn home(modules: &Modules, path: &[String], depth: usize) -> Home {
    let mut at = Name::new();
    for (i, segment) in path.iter().enumerate() {
        let child = [at.as_slice(), std::slice::from_ref(segment)].concat();
        if modules.contains_key(&child) {
            at = child;
            continue;
        }
        let Some(module) = modules.get(&at) else { return Home::Unknown };
        if module.defined.contains(segment) || depth > 8 {
            return Home::Item(at);
        }
        let known = module.scope.get(segment).and_then(|known| absolute(modules, &at, module, known));
        if let Some(known) = known {
            return home(modules, &[&known, &path[i + 1..]].concat(), depth + 1);
        }
        for glob in module.globs.iter().filter_map(|glob| absolute(modules, &at, module, glob)) {
            let inside = [glob, path[i..].to_vec()].concat();
            if modules.get(&inside[..inside.len() - (path.len() - i)]).is_some_and(|m| m.defined.contains(segment)) {
                return home(modules, &inside, depth + 1);
            }
        }
        return Home::Item(at);
    }
    Home::Module(at)
}
