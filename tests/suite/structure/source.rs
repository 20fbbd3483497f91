//! Reads a crate's modules: definitions, imports, uses.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};

/// Module path from the crate root.
pub type ModulePath = Vec<String>;

/// Import by `use`.
#[derive(Debug)]
pub struct Import {
    /// Path as written.
    pub path: Vec<String>,
    /// Re-export (`pub use`).
    pub public: bool,
}

/// Module, inline or a file.
#[derive(Debug, Default)]
pub struct Scope {
    /// File relative to the repository.
    pub file: String,
    /// Defined items.
    pub items: BTreeSet<String>,
    /// Imported names.
    pub imports: BTreeMap<String, Import>,
    /// Glob imports.
    pub globs: Vec<Vec<String>>,
    /// Paths in code, signatures and macro calls.
    pub paths: BTreeSet<Vec<String>>,
    /// Inherent methods with their types.
    pub methods: Vec<(Vec<String>, String)>,
    /// Called methods.
    pub calls: BTreeSet<String>,
}

/// Scopes of a crate by module path, without test code.
pub type Scopes = BTreeMap<ModulePath, Scope>;

/// Reads a crate from its root file.
pub fn read_crate(repository: &Path, root: &str) -> Scopes {
    let mut scopes = Scopes::new();
    let folder = root.rsplit_once('/').expect("a root file lies in a folder").0;
    read_module(repository, root, folder, vec![], &mut scopes);
    scopes
}

fn read_module(repository: &Path, file: &str, folder: &str, module: ModulePath, scopes: &mut Scopes) {
    let text = fs::read_to_string(repository.join(file)).unwrap_or_else(|e| panic!("{file}: {e}"));
    let parsed = syn::parse_file(&text).unwrap_or_else(|e| panic!("{file}: {e}"));
    read_items(repository, file, folder, module, &parsed.items, scopes);
}

fn read_items(
    repository: &Path,
    file: &str,
    folder: &str,
    module: ModulePath,
    items: &[syn::Item],
    scopes: &mut Scopes,
) {
    let mut scope = Scope { file: file.into(), ..Scope::default() };
    for item in items.iter().filter(|i| !for_tests(attributes(i))) {
        if let Some(name) = defined(item) {
            scope.items.insert(name);
        }
        match item {
            syn::Item::Mod(m) => {
                let name = m.ident.to_string();
                let (below, inner) =
                    (format!("{folder}/{name}"), [module.clone(), vec![name.clone()]].concat());
                match &m.content {
                    Some((_, items)) => read_items(repository, file, &below, inner, items, scopes),
                    None => {
                        let flat = format!("{below}.rs");
                        let nested = format!("{below}/mod.rs");
                        let file = if repository.join(&flat).is_file() { flat } else { nested };
                        read_module(repository, &file, &below, inner, scopes);
                    }
                }
            }
            syn::Item::Use(u) => {
                let public = !matches!(u.vis, syn::Visibility::Inherited);
                flatten(&u.tree, &mut vec![], public, &mut scope);
            }
            _ => Names(&mut scope).visit_item(item),
        }
    }
    scopes.insert(module, scope);
}

/// Whether an item is test code.
pub fn for_tests(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|a| {
        a.path().is_ident("test")
            || (a.path().is_ident("cfg") && a.parse_args::<syn::Ident>().is_ok_and(|i| i == "test"))
    })
}

fn attributes(item: &syn::Item) -> &[syn::Attribute] {
    match item {
        syn::Item::Const(i) => &i.attrs,
        syn::Item::Enum(i) => &i.attrs,
        syn::Item::Fn(i) => &i.attrs,
        syn::Item::Impl(i) => &i.attrs,
        syn::Item::Macro(i) => &i.attrs,
        syn::Item::Mod(i) => &i.attrs,
        syn::Item::Static(i) => &i.attrs,
        syn::Item::Struct(i) => &i.attrs,
        syn::Item::Trait(i) => &i.attrs,
        syn::Item::Type(i) => &i.attrs,
        syn::Item::Use(i) => &i.attrs,
        _ => &[],
    }
}

fn defined(item: &syn::Item) -> Option<String> {
    Some(match item {
        syn::Item::Const(i) => i.ident.to_string(),
        syn::Item::Enum(i) => i.ident.to_string(),
        syn::Item::Fn(i) => i.sig.ident.to_string(),
        syn::Item::Macro(i) => i.ident.as_ref()?.to_string(),
        syn::Item::Static(i) => i.ident.to_string(),
        syn::Item::Struct(i) => i.ident.to_string(),
        syn::Item::Trait(i) => i.ident.to_string(),
        syn::Item::Type(i) => i.ident.to_string(),
        _ => return None,
    })
}

fn flatten(tree: &syn::UseTree, at: &mut Vec<String>, public: bool, scope: &mut Scope) {
    match tree {
        syn::UseTree::Path(p) => {
            at.push(p.ident.to_string());
            flatten(&p.tree, at, public, scope);
            at.pop();
        }
        syn::UseTree::Group(g) => g.items.iter().for_each(|t| flatten(t, at, public, scope)),
        syn::UseTree::Glob(_) => scope.globs.push(at.clone()),
        syn::UseTree::Name(n) if n.ident == "self" => add(at.clone(), at.last().cloned(), public, scope),
        syn::UseTree::Name(n) => {
            let name = n.ident.to_string();
            add([at.clone(), vec![name.clone()]].concat(), Some(name), public, scope);
        }
        syn::UseTree::Rename(r) => {
            let mut path = at.clone();
            if r.ident != "self" {
                path.push(r.ident.to_string());
            }
            add(path, Some(r.rename.to_string()), public, scope);
        }
    }
}

fn add(path: Vec<String>, name: Option<String>, public: bool, scope: &mut Scope) {
    if let Some(name) = name {
        scope.imports.insert(name, Import { path, public });
    }
}

struct Names<'a>(&'a mut Scope);

impl<'ast> Visit<'ast> for Names<'_> {
    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.0.paths.insert(path.segments.iter().map(|s| s.ident.to_string()).collect());
        visit::visit_path(self, path);
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        flatten(&item.tree, &mut vec![], false, self.0);
    }

    fn visit_item_impl(&mut self, item: &'ast syn::ItemImpl) {
        if let (None, syn::Type::Path(of)) = (&item.trait_, &*item.self_ty) {
            let of: Vec<String> = of.path.segments.iter().map(|s| s.ident.to_string()).collect();
            for inner in &item.items {
                if let syn::ImplItem::Fn(f) = inner {
                    self.0.methods.push((of.clone(), f.sig.ident.to_string()));
                }
            }
        }
        visit::visit_item_impl(self, item);
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        if !for_tests(&item.attrs) {
            visit::visit_impl_item_fn(self, item);
        }
    }

    fn visit_expr_method_call(&mut self, call: &'ast syn::ExprMethodCall) {
        self.0.calls.insert(call.method.to_string());
        visit::visit_expr_method_call(self, call);
    }

    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        tokens(call.tokens.clone(), self.0);
        visit::visit_macro(self, call);
    }
}

/// Paths and method calls in macro tokens.
fn tokens(stream: proc_macro2::TokenStream, scope: &mut Scope) {
    use proc_macro2::TokenTree;
    let mut path: Vec<String> = Vec::new();
    let (mut colons, mut dot) = (0, false);
    for token in stream {
        match token {
            TokenTree::Ident(name) => {
                if dot {
                    scope.calls.insert(name.to_string());
                }
                if colons != 2 && !path.is_empty() {
                    scope.paths.insert(std::mem::take(&mut path));
                }
                path.push(name.to_string());
                (colons, dot) = (0, false);
            }
            TokenTree::Punct(p) if p.as_char() == ':' => colons += 1,
            TokenTree::Punct(p) => (colons, dot) = (0, p.as_char() == '.'),
            TokenTree::Group(g) => {
                (colons, dot) = (0, false);
                tokens(g.stream(), scope);
            }
            TokenTree::Literal(_) => (colons, dot) = (0, false),
        }
    }
    if !path.is_empty() {
        scope.paths.insert(path);
    }
}

/// Length of a function.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Length {
    /// Lines from name to closing brace.
    pub lines: usize,
    /// `file:line name`.
    pub place: String,
}

/// Lengths of all functions, tests included.
pub fn functions(file: &str, text: &str) -> Vec<Length> {
    struct Functions<'a>(&'a str, Vec<Length>);
    impl Functions<'_> {
        fn add(&mut self, signature: &syn::Signature, block: &syn::Block) {
            let (first, last) = (signature.span().start().line, block.span().end().line);
            let place = format!("{}:{first} {}", self.0, signature.ident);
            self.1.push(Length { lines: last + 1 - first, place });
        }
    }
    impl<'ast> Visit<'ast> for Functions<'_> {
        fn visit_item_fn(&mut self, f: &'ast syn::ItemFn) {
            self.add(&f.sig, &f.block);
            visit::visit_item_fn(self, f);
        }
        fn visit_impl_item_fn(&mut self, f: &'ast syn::ImplItemFn) {
            self.add(&f.sig, &f.block);
            visit::visit_impl_item_fn(self, f);
        }
        fn visit_trait_item_fn(&mut self, f: &'ast syn::TraitItemFn) {
            if let Some(block) = &f.default {
                self.add(&f.sig, block);
            }
            visit::visit_trait_item_fn(self, f);
        }
    }
    let parsed = syn::parse_file(text).unwrap_or_else(|e| panic!("{file}: {e}"));
    let mut all = Functions(file, Vec::new());
    all.visit_file(&parsed);
    all.1
}
