//! Names of bodies, walls and materials in messages.

/// Names; an object without one is called by its index.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names {
    /// Of the body groups.
    pub groups: Vec<String>,
    /// Of the planes.
    pub planes: Vec<String>,
    /// Of the walls, triangle surfaces first.
    pub walls: Vec<String>,
    /// Of the materials.
    pub materials: Vec<String>,
}

impl Names {
    /// Returns `body 12 of "ballast"`.
    pub fn body(&self, group: u32, body: usize) -> String {
        match named(&self.groups, group as usize) {
            Some(name) => format!("body {body} of {name:?}"),
            None => format!("body {body}"),
        }
    }

    /// Returns the name of a plane.
    pub fn plane(&self, plane: usize) -> String {
        named(&self.planes, plane).map_or_else(|| format!("plane {plane}"), |name| kind("wall", name))
    }

    /// Returns the name of a wall.
    pub fn wall(&self, wall: usize) -> String {
        named(&self.walls, wall).map_or_else(|| format!("wall {wall}"), |name| kind("wall", name))
    }

    /// Returns the name of a material.
    pub fn material(&self, material: usize) -> String {
        named(&self.materials, material).map_or_else(|| format!("material {material}"), String::from)
    }

    /// Replaces "body 12", "plane 0" and "wall 1" of a message; `group`: of a body.
    pub fn replace(&self, message: &str, group: impl Fn(usize) -> Option<u32>) -> String {
        let mut words: Vec<String> = message.split(' ').map(String::from).collect();
        for k in 1..words.len() {
            let digits = words[k].trim_end_matches([',', ':', ';', '.', ')']);
            let Ok(index) = digits.parse::<usize>() else { continue };
            let kind = words[k - 1].trim_start_matches('(');
            let name = match kind {
                "body" => group(index).map(|group| self.body(group, index)),
                "plane" => Some(self.plane(index)),
                "wall" => Some(self.wall(index)),
                _ => None,
            };
            let Some(name) = name else { continue };
            let start = &words[k - 1][..words[k - 1].len() - kind.len()];
            words[k] = format!("{start}{name}{}", &words[k][digits.len()..]);
            words[k - 1].clear();
        }
        words.retain(|word| !word.is_empty());
        words.join(" ")
    }
}

fn named(names: &[String], index: usize) -> Option<&str> {
    names.get(index).map(String::as_str).filter(|name| !name.is_empty())
}

/// `wall "top"`, but `wall3`.
fn kind(kind: &str, name: &str) -> String {
    let number = name.strip_prefix(kind).filter(|rest| !rest.is_empty());
    if number.is_some_and(|rest| rest.bytes().all(|b| b.is_ascii_digit())) {
        name.to_string()
    } else {
        format!("{kind} {name:?}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_name_objects() {
        let names = Names {
            groups: vec!["ballast".into()],
            planes: vec!["floor".into()],
            walls: vec!["wall2".into(), String::new()],
            ..Names::default()
        };
        let named = names
            .replace("at t = 1 s: overlap of body 12 and plane 0: 3 m (wall 0, wall 1, body 13).", |body| {
                (body < 13).then_some(0)
            });
        assert_eq!(
            named,
            "at t = 1 s: overlap of body 12 of \"ballast\" and wall \"floor\": 3 m (wall2, wall 1, body 13)."
        );
    }
}
