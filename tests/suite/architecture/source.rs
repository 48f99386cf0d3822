//! A crate's modules: which file is which, what each defines, what it brings into scope, which paths it names.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crate::architecture::tokens::{Token, tokens};

/// A path by its segments, from the crate's root; the root itself is empty.
pub type Name = Vec<String>;

/// One file.
#[derive(Debug, Default)]
pub struct Module {
    /// Items that it defines itself.
    pub defined: BTreeSet<String>,
    /// Names that it brings into scope, with their paths as written.
    pub scope: BTreeMap<String, Name>,
    /// Modules of which it takes all names.
    pub globs: Vec<Name>,
    /// Those of its names and globs that it only hands on: `pub use`.
    pub handed_on: BTreeSet<String>,
    /// Paths in its code, as written.
    pub paths: Vec<Name>,
    /// How often its code has each word, `use` lines aside.
    words: BTreeMap<String, usize>,
}

impl Module {
    pub fn mentions(&self, word: &str) -> bool {
        self.words.contains_key(word)
    }
}

/// All files of a crate by module.
pub type Modules = BTreeMap<Name, Module>;

/// Reads a crate from its folder of sources; modules of tests are left out.
pub fn read(folder: &Path) -> Modules {
    let mut modules = Modules::new();
    for root in ["lib.rs", "main.rs"].iter().map(|name| folder.join(name)).filter(|path| path.exists()).take(1) {
        read_module(&root, folder, Vec::new(), &mut modules);
    }
    modules
}

fn read_module(file: &Path, folder: &Path, name: Name, modules: &mut Modules) {
    let tokens = tokens(&std::fs::read_to_string(file).unwrap());
    for child in declared(&tokens) {
        let own = [name.as_slice(), std::slice::from_ref(&child)].concat();
        let inside = folder.join(&child);
        let file = [folder.join(format!("{child}.rs")), inside.join("mod.rs")].into_iter().find(|path| path.exists());
        read_module(&file.unwrap_or_else(|| panic!("{own:?} has no file")), &inside, own, modules);
    }
    modules.insert(name, module(&tokens));
}

/// The modules that a file declares: `mod NAME;`.
fn declared(tokens: &[Token]) -> Vec<String> {
    let is_mod = |three: &&[Token]| three[0].word() == Some("mod") && three[2].is(';');
    tokens.windows(3).filter(is_mod).filter_map(|three| three[1].word().map(str::to_owned)).collect()
}

const ITEMS: [&str; 9] = ["fn", "struct", "enum", "trait", "type", "const", "static", "union", "macro_rules"];

fn module(tokens: &[Token]) -> Module {
    let mut module = Module::default();
    let (mut i, mut depth) = (0, 0_usize);
    while i < tokens.len() {
        match &tokens[i] {
            Token::Sign('{') => depth += 1,
            Token::Sign('}') => depth = depth.saturating_sub(1),
            Token::Word(word) if word == "mod" && tokens.get(i + 2).is_some_and(|end| end.is(';')) => i += 2,
            // `use<...>` in a type is no import
            Token::Word(word) if word == "use" && !tokens.get(i + 1).is_some_and(|next| next.is('<')) => {
                let public = i > 0 && (tokens[i - 1].word() == Some("pub") || tokens[i - 1].is(')'));
                let end = (i..tokens.len()).find(|&k| tokens[k].is(';')).unwrap_or(tokens.len());
                import(&tokens[i + 1..end], &mut Name::new(), public, &mut module);
                i = end;
            }
            Token::Word(word) => {
                let behind = i > 0 && tokens[i - 1] == Token::Path;
                if depth == 0 && ITEMS.contains(&word.as_str()) {
                    let name = tokens[i + 1..].iter().find_map(Token::word).filter(|name| *name != "fn");
                    module.defined.extend(name.map(str::to_owned));
                }
                if !behind {
                    let path = path_at(tokens, i);
                    *module.words.entry(word.clone()).or_default() += 1;
                    if path.len() > 1 {
                        module.paths.push(path);
                    }
                }
            }
            _ => {}
        }
        i += 1;
    }
    module
}

/// The words that `::` joins from `i` on.
fn path_at(tokens: &[Token], mut i: usize) -> Name {
    let mut path = Name::new();
    while let Some(Token::Word(word)) = tokens.get(i) {
        path.push(word.clone());
        if tokens.get(i + 1) != Some(&Token::Path) {
            break;
        }
        i += 2;
    }
    path
}

/// Takes in the tree of one `use`.
fn import(tree: &[Token], before: &mut Name, public: bool, module: &mut Module) {
    let mut path = before.clone();
    let mut i = 0;
    while i < tree.len() {
        match &tree[i] {
            Token::Word(word) if word == "as" => {
                let alias = tree.get(i + 1).and_then(Token::word).unwrap_or("_").to_owned();
                return bring(alias, path, public, module);
            }
            Token::Word(word) => path.push(word.clone()),
            Token::Sign('*') => {
                if public {
                    module.handed_on.insert(path.join("::"));
                }
                return module.globs.push(path);
            }
            Token::Sign('{') => {
                for branch in branches(&tree[i + 1..tree.len() - 1]) {
                    import(branch, &mut path.clone(), public, module);
                }
                return;
            }
            _ => {}
        }
        i += 1;
    }
    if path.last().is_some_and(|last| last == "self") {
        path.pop();
    }
    if let Some(name) = path.last().cloned() {
        bring(name, path, public, module);
    }
}

fn bring(name: String, path: Name, public: bool, module: &mut Module) {
    if public {
        module.handed_on.insert(name.clone());
    }
    module.scope.insert(name, path);
}

/// The branches between the braces of a `use`.
fn branches(tree: &[Token]) -> Vec<&[Token]> {
    let mut depth = 0;
    let at_comma = |token: &Token| {
        depth += i32::from(token.is('{')) - i32::from(token.is('}'));
        depth == 0 && token.is(',')
    };
    tree.split(at_comma).filter(|branch| !branch.is_empty()).collect()
}
