//! Converts deck keys to a scene.

use super::values::Deck;
use crate::convert::options::Options;
use std::fmt::Write;
use std::path::Path;
use trackbed_io::failure::Failure;

pub struct Made {
    pub text: String,
    /// Conversion notes.
    pub remarks: Vec<String>,
}

pub(super) struct Maker<'a> {
    pub(super) deck: &'a Deck,
    text: String,
    pub(super) became: Vec<(&'static str, bool, String)>,
    /// Diameter [m].
    pub(super) diameter: f64,
    /// Grain–grain contact stiffness [N/m].
    pub(super) stiffness: f64,
    bonded: bool,
}

/// Converts the deck to a scene at `output`.
///
/// # Errors
/// Values out of range, missing files.
pub fn scene(deck: &Deck, output: &Path, options: &Options) -> Result<Made, Failure> {
    let above = |x: f64| x > 0.0;
    let diameter = deck.number("D", above, "a diameter above 0")?;
    let young = deck.number("YoungM", above, "a modulus above 0")?;
    let bonded = deck.number(strength(deck), |s| s >= 0.0, "0 MPa or more")? > 0.0;
    let mut maker = Maker {
        deck,
        text: String::new(),
        became: Vec::new(),
        diameter,
        stiffness: young * diameter,
        bonded,
    };
    maker.materials()?;
    maker.grains(output, options)?;
    if bonded {
        maker.bonds()?;
    } else {
        for key in ["BOND_MODEL", "RPBN", "RPBS", "BONDNS", "BSIGMA", strength(deck)] {
            maker.left(key, "the strength of the bonds is 0: there are none");
        }
    }
    maker.walls(output, options)?;
    maker.duration()?;
    maker.rest()?;
    Ok(maker.finish())
}

pub(super) fn strength(deck: &Deck) -> &'static str {
    if deck.geology { "BSTRENGTH" } else { "MEANBOND" }
}

impl Maker<'_> {
    pub(super) fn used(&mut self, key: &'static str, how: &str) {
        self.became.push((key, true, how.to_string()));
    }

    /// Records an unused key, if present.
    pub(super) fn left(&mut self, key: &'static str, why: &str) {
        if self.deck.has(key) && self.became.iter().all(|(k, _, _)| *k != key) {
            self.became.push((key, false, why.to_string()));
        }
    }

    pub(super) fn line(&mut self, text: &str) {
        self.text.push_str(text);
        self.text.push('\n');
    }

    fn materials(&mut self) -> Result<(), Failure> {
        let d = self.deck;
        let above = |x: f64| x > 0.0;
        let density = d.number("dens", above, "a density above 0")?;
        let young = d.number("YoungM", above, "a modulus above 0")?;
        let poisson = d.number("PoissonR", |p| (0.0..=0.5).contains(&p), "0 to 0.5")?;
        let ratio = d.number("rns", |r| r >= 0.0, "0 or more")?;
        let dashpots = d.number("rzs", |r| (0.0..=1.0).contains(&r), "0 to 1")?;
        let friction = d.number("amu", |r| r >= 0.0, "0 or more")?;
        let restitution = d.number("eps", |r| r > 0.0 && r <= 1.0, "above 0, at most 1")?;
        let hertz = d.number("TContact", |m| m == 1.0 || m == 2.0, "1 or 2")? == 2.0;
        let gravity = d.number("gz", |g| g >= 0.0, "0 or more, downwards")?;
        let (rolling, why) =
            match d.has("ARF").then(|| d.number("ARF", |a| a >= 0.0, "0 or more")).transpose()? {
                Some(a) if a <= 1.0 => (Some(a), ""),
                Some(_) => (
                    None,
                    "no coefficient of rolling friction is above 1, and no other meaning is given: doubtful",
                ),
                None => (None, ""),
            };
        let wall = [
            d.number("nu_Wall", |r| r >= 0.0, "0 or more")?,
            d.number("eps_Wall", above, "above 0, at most 1")?,
        ];
        self.line(&format!(
            "gravity = [0.0, 0.0, -{gravity:?}]\n\n[[material]]\nname = \"grains\"\ndensity = {density:?}"
        ));
        let spring = match hertz {
            true => format!("young = {young:?}\npoisson = {poisson:?}"),
            false => format!("stiffness = {:?}\ntangential_ratio = {ratio:?}", self.stiffness),
        };
        self.line(&spring);
        if d.has("YMSIGMA") {
            let deviation = d.number("YMSIGMA", |s| s >= 0.0, "0 or more")? / young;
            if deviation > 0.0 {
                self.line(&format!("stiffness_spread = {{ kind = \"normal\", deviation = {deviation:?} }}"));
            }
            let bonds = if self.bonded { " and that of bonds" } else { "" };
            self.used("YMSIGMA", &format!("stiffness_spread of grains{bonds}"));
        }
        let rolling_line = rolling.map_or(String::new(), |a| format!("rolling_friction = {a:?}\n"));
        self.line(&format!("tangential_damping_ratio = {dashpots:?}\nfriction = {friction:?}\nrestitution = {restitution:?}\n{rolling_line}"));
        // Walls as stiff as grains: the pair then has the grain stiffness.
        self.line(&format!(
            "[[material]]\nname = \"walls\"\n{spring}\nfriction = {:?}\nrestitution = {:?}\n",
            wall[0], wall[1]
        ));
        self.line(&format!(
            "[[contact]]\nbetween = [\"grains\", \"walls\"]\nfriction = {:?}\nrestitution = {:?}\n",
            wall[0], wall[1]
        ));
        for (key, how) in
            [("gz", "gravity"), ("dens", "density"), ("rzs", "tangential_damping_ratio"), ("amu", "friction")]
        {
            self.used(key, how);
        }
        self.used("eps", "restitution");
        self.used("TContact", if hertz { "law after Hertz: young, poisson" } else { "linear law" });
        self.used("D", "diameter");
        if hertz {
            self.used("YoungM", "young");
            self.used("PoissonR", "poisson");
            self.left("rns", "under Hertz' law the tangential stiffness follows from Poisson's ratio");
        } else {
            self.used("YoungM", "stiffness = YoungM x D, of a bar of the grain's length and square");
            self.used("rns", "tangential_ratio");
            self.left("PoissonR", "the linear law has none");
        }
        if rolling.is_some() {
            self.used("ARF", "rolling_friction");
        }
        self.left("ARF", why);
        self.used("nu_Wall", "friction of [[contact]] with walls");
        self.used("eps_Wall", "restitution of [[contact]] with walls");
        Ok(())
    }

    fn grains(&mut self, output: &Path, options: &Options) -> Result<(), Failure> {
        let d = self.deck;
        let restart = d.logical("restart")?;
        let origin = ["X0", "Y0", "Z0"].map(|k| d.number(k, |_| true, "a coordinate"));
        let [x, y, z] = [origin[0].clone()?, origin[1].clone()?, origin[2].clone()?];
        let kind = match d.word("pattern").as_str() {
            "hex" => "hexagonal",
            "fcc" => "face_centred",
            "los" => "loose",
            _ => return Err(d.error("pattern", "HEX, FCC or LOS").into()),
        };
        self.line("[[grains]]\nname = \"grains\"\nshape = \"sphere\"\nmaterial = \"grains\"");
        if let Some(packing) = &options.packing {
            if !restart {
                let expected = ".true. with --packing, or no packing";
                return Err(d.error("restart", expected).into());
            }
            self.line(&format!("packing = {:?}\n", relative(packing, output)));
            self.used("restart", "the packing of --packing");
            for key in
                ["pattern", "NICEX", "NICEY", "NICEZ", "IPATTERN", "DMAX/D", "DMIN/D", "cc", "X0", "Y0", "Z0"]
            {
                self.left(key, "the packing has places and sizes");
            }
        } else if d.geology {
            let count =
                |k| d.number(k, |n| n >= 1.0 && n.fract() == 0.0 && n < 1e7, "a whole number from 1 on");
            let counts = [count("NICEX")?, count("NICEY")?, count("NICEZ")?].map(|n| n as u64);
            self.line(&format!(
                "lattice = {{ kind = \"{kind}\", size = {:?}, low = [{x:?}, {y:?}, {z:?}], counts = {counts:?} }}\n",
                self.diameter
            ));
            self.used("pattern", "lattice.kind");
            for key in ["NICEX", "NICEY", "NICEZ"] {
                self.used(key, "lattice.counts");
            }
            for key in ["X0", "Y0", "Z0"] {
                self.used(key, "lattice.low");
            }
            self.left("restart", "no --packing was given: initial lattice of the deck");
            for key in ["IPATTERN", "DMAX/D", "DMIN/D"] {
                self.left(key, "grains of a lattice are equal; give the grown packing by --packing");
            }
            self.left("cc", "set by the lattice");
        } else {
            self.scattered(options, [x, y, z])?;
        }
        Ok(())
    }

    fn scattered(&mut self, options: &Options, low: [f64; 3]) -> Result<(), Failure> {
        let d = self.deck;
        let Some(size) = options.region else {
            let expected = "--packing FILE, or --box X,Y,Z, as the deck contains no number of grains";
            return Err(d.error("restart", expected).into());
        };
        let share = d.number("cc", |c| c > 0.0 && c < 1.0, "above 0, below 1")?;
        let most = self.diameter * d.number("DMAX/D", |r| r >= 1.0, "1 or more")?;
        let least = self.diameter * d.number("DMIN/D", |r| r > 0.0 && r <= 1.0, "above 0, at most 1")?;
        let sizes = match d.number("IPATTERN", |p| (0.0..=4.0).contains(&p) && p.fract() == 0.0, "0 to 4")? {
            0.0 => format!("law = \"monodisperse\", size = {:?}", self.diameter),
            1.0 => format!("law = \"bidisperse\", small = {least:?}, large = {most:?}, large_share = 0.5"),
            2.0 => format!("law = \"uniform\", low = {least:?}, high = {most:?}"),
            // The deck has no deviation: two deviations reach the limits.
            3.0 => {
                let deviation = 0.25 * (most - least);
                let mean = self.diameter;
                format!(
                    "law = \"normal\", mean = {mean:?}, deviation = {deviation:?}, low = {least:?}, high = {most:?}"
                )
            }
            _ => {
                let deviation = 0.25 * libm::log(most / least);
                let median = self.diameter;
                format!(
                    "law = \"log_normal\", median = {median:?}, deviation = {deviation:?}, low = {least:?}, high = {most:?}"
                )
            }
        };
        let high = [0, 1, 2].map(|k| low[k] + size[k]);
        self.line(&format!(
            "region = {{ box = [{low:?}, {high:?}] }}\nsolid_fraction = {share:?}\nsizes = {{ {sizes} }}\n"
        ));
        self.used("cc", "solid_fraction");
        for key in ["IPATTERN", "DMAX/D", "DMIN/D"] {
            self.used(
                key,
                "sizes; of normal laws two deviations reach the limits, which the deck leaves open",
            );
        }
        for key in ["X0", "Y0", "Z0"] {
            self.used(key, "lower corner of the box of --box");
        }
        self.left("restart", "no --packing was given: grains at random places");
        self.left("pattern", "grains at random places");
        Ok(())
    }

    fn finish(self) -> Made {
        let name = if self.deck.geology { "2011" } else { "2013" };
        let mut remarks = Vec::new();
        let mut head = format!("# From a parameter deck of {name}. What became of its keys:\n");
        for key in self.deck.keys() {
            let became = self.became.iter().find(|(k, _, _)| *k == key);
            let (used, how) =
                became.map_or((false, "no meaning here"), |(_, used, how)| (*used, how.as_str()));
            let line = if used { format!("{key}: {how}") } else { format!("{key}: not used: {how}") };
            writeln!(head, "#   {line}").expect("writing to a string does not fail");
            remarks.push(line);
        }
        let title = format!("title = \"Deck of {name}{}\"\n", if self.bonded { ", bonded" } else { "" });
        Made { text: format!("{head}{title}{}", self.text), remarks }
    }
}

/// Path relative to the scene, absolute if unclear.
pub(super) fn relative(file: &Path, output: &Path) -> String {
    let folder = output.parent().unwrap_or(Path::new(""));
    match file.strip_prefix(folder) {
        Ok(inside) => inside.display().to_string(),
        Err(_) => std::path::absolute(file).unwrap_or_else(|_| file.to_path_buf()).display().to_string(),
    }
}
