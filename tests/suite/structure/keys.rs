//! Keys in messages and keys of a scene.

use std::collections::BTreeSet;
use syn::visit::{self, Visit};

/// Functions with a key argument and its index.
const FUNCTIONS: [(&str, usize); 12] = [
    ("find", 2),
    ("region", 1),
    ("box_region", 1),
    ("direction", 1),
    ("plane", 2),
    ("above_zero", 1),
    ("least_zero", 1),
    ("few", 1),
    ("fault", 0),
    ("check", 0),
    ("conflicting", 0),
    ("faulty", 0),
];

/// Methods with a key as first argument.
const METHODS: [&str; 13] = [
    "error",
    "missing",
    "conflict",
    "requirement",
    "no_effect",
    "problem",
    "need",
    "check",
    "below",
    "optional",
    "row",
    "rows",
    "strength",
];

/// Adds keys declared for `serde`: fields of structs and variants.
pub fn declared(text: &str, keys: &mut BTreeSet<String>) {
    struct Fields<'a>(&'a mut BTreeSet<String>);
    impl<'ast> Visit<'ast> for Fields<'_> {
        fn visit_field(&mut self, field: &'ast syn::Field) {
            let mut key = field.ident.as_ref().map(ToString::to_string);
            for attribute in field.attrs.iter().filter(|a| a.path().is_ident("serde")) {
                // Only `rename` matters.
                let _ = attribute.parse_nested_meta(|meta| {
                    let value = meta.value()?.parse::<syn::LitStr>()?;
                    if meta.path.is_ident("rename") {
                        key = Some(value.value());
                    }
                    Ok(())
                });
            }
            self.0.extend(key);
        }
    }
    Fields(keys).visit_file(&syn::parse_file(text).expect("sources can be parsed"));
}

/// Keys in literals with lines; `sleeper.mass` is two.
pub fn named(text: &str) -> Vec<(usize, String)> {
    struct Names(Vec<(usize, String)>);
    impl Names {
        fn add(&mut self, expression: &syn::Expr) {
            let syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(literal), .. }) = expression else { return };
            let line = literal.span().start().line;
            let value = literal.value();
            let parts = value.split('.').filter(|part| part.parse::<u32>().is_err());
            self.0.extend(parts.map(|part| (line, part.to_string())));
        }
    }
    impl<'ast> Visit<'ast> for Names {
        fn visit_expr_method_call(&mut self, call: &'ast syn::ExprMethodCall) {
            if METHODS.iter().any(|m| call.method == m)
                && let Some(first) = call.args.first()
            {
                self.add(first);
            }
            visit::visit_expr_method_call(self, call);
        }

        fn visit_expr_call(&mut self, call: &'ast syn::ExprCall) {
            if let syn::Expr::Path(function) = &*call.func
                && let Some(name) = function.path.segments.last()
                && let Some((_, place)) = FUNCTIONS.iter().find(|(f, _)| name.ident == f)
                && let Some(key) = call.args.get(*place)
            {
                self.add(key);
            }
            visit::visit_expr_call(self, call);
        }

        fn visit_expr_tuple(&mut self, tuple: &'ast syn::ExprTuple) {
            let text = |e: &syn::Expr| matches!(e, syn::Expr::Lit(_) | syn::Expr::Macro(_));
            let sentence = |e: &syn::Expr| match e {
                syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(literal), .. }) => {
                    literal.value().contains(' ')
                }
                _ => false,
            };
            if tuple.elems.len() > 1 && !sentence(&tuple.elems[0]) && !tuple.elems.iter().skip(1).any(text) {
                self.add(&tuple.elems[0]);
            }
            visit::visit_expr_tuple(self, tuple);
        }

        fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
            if !super::source::for_tests(&item.attrs) {
                visit::visit_item_mod(self, item);
            }
        }
    }
    let mut names = Names(Vec::new());
    names.visit_file(&syn::parse_file(text).expect("sources can be parsed"));
    names.0
}
