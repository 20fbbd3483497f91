//! Converts keys of bonds, walls, time and output.

use super::scene::{Maker, relative, strength};
use crate::convert::options::Options;
use std::f64::consts::PI;
use std::path::Path;
use trackbed_io::failure::Failure;

impl Maker<'_> {
    pub(super) fn bonds(&mut self) -> Result<(), Failure> {
        let d = self.deck;
        let ratio = |k: &'static str| if d.has(k) { d.number(k, |r| r > 0.0, "above 0") } else { Ok(1.0) };
        let (normal, shear, rns) = (ratio("RPBN")?, ratio("RPBS")?, ratio("rns")?);
        let mean = 1e6 * d.number(strength(d), |s| s >= 0.0, "0 MPa or more")?;
        let area = 0.25 * PI * self.diameter * self.diameter;
        let in_shear = ratio("BONDNS")? * mean;
        // Neighbours of a lattice or packing touch up to rounding.
        self.line(&format!("[[bond]]\nname = \"bonds\"\ngap = {:?}\ncontact = true", 0.01 * self.diameter));
        match d.word("BOND_MODEL").as_str() {
            "p" => self.line(&format!(
                "parallel = {{ normal_stiffness = {:?}, shear_stiffness = {:?}, tensile_strength = {mean:?}, shear_strength = {in_shear:?} }}",
                normal * self.stiffness / area,
                shear * rns * self.stiffness / area
            )),
            "c" => self.line(&format!(
                "contact_point = {{ normal_stiffness = {:?}, shear_stiffness = {:?}, tension_limit = {:?}, shear_limit = {:?} }}",
                normal * self.stiffness,
                shear * rns * self.stiffness,
                mean * area,
                in_shear * area
            )),
            _ => return Err(d.error("BOND_MODEL", "P or C").into()),
        }
        self.used("BOND_MODEL", "parallel or contact_point");
        self.used(strength(d), "tensile and shear strength");
        for (key, how) in [
            ("RPBN", "normal stiffness ratio of bond to contact (the deck calls it strength: wrong)"),
            ("RPBS", "shear stiffness ratio of bond to contact"),
            ("BONDNS", "shear over tensile strength"),
        ] {
            if d.has(key) {
                self.used(key, how);
            }
        }
        for (key, of, table) in [
            ("BSIGMA", mean / 1e6, "spread"),
            ("YMSIGMA", self.stiffness / self.diameter, "stiffness_spread"),
        ] {
            if d.has(key) {
                let deviation = d.number(key, |s| s >= 0.0, "0 or more")? / of;
                if deviation > 0.0 {
                    self.line(&format!("{table} = {{ kind = \"normal\", deviation = {deviation:?} }}"));
                }
                if key == "BSIGMA" {
                    self.used(key, &format!("bond.{table}"));
                }
            }
        }
        self.line("");
        Ok(())
    }

    pub(super) fn walls(&mut self, output: &Path, options: &Options) -> Result<(), Failure> {
        if let Some(terrain) = &options.terrain {
            let file = relative(terrain, output);
            self.line(&format!(
                "[[walls]]\nname = \"terrain\"\nkind = \"mesh\"\nmaterial = \"walls\"\nfile = {file:?}\n"
            ));
        } else if let Some(size) = options.region.filter(|_| !self.deck.geology) {
            let low = [0, 1, 2].map(|k| self.deck.number(["X0", "Y0", "Z0"][k], |_| true, "a coordinate"));
            for (k, low) in low.into_iter().enumerate() {
                let low = low?;
                for (at, sign) in [(low, 1.0), (low + size[k], -1.0)] {
                    let (mut point, mut normal) = ([0.0; 3], [0.0; 3]);
                    (point[k], normal[k]) = (at, sign);
                    self.line(&format!("[[walls]]\nkind = \"plane\"\nmaterial = \"walls\"\npoint = {point:?}\nnormal = {normal:?}\n"));
                }
            }
            if self.deck.number("Nwall", |n| n >= 0.0, "0 or more")? == 6.0 {
                self.used("Nwall", "the six planes of --box");
            }
        }
        self.left("Nwall", "walls come from --terrain or --box");
        self.left("NPOINT", "not explained; walls come from --terrain or --box");
        Ok(())
    }

    pub(super) fn duration(&mut self) -> Result<(), Failure> {
        let d = self.deck;
        let above = |x: f64| x > 0.0;
        let steps = d.number("nstep", above, "above 0")?;
        let divisor = d.number("icont", above, "above 0")?;
        let restitution = d.number("eps", above, "above 0")?;
        let least = self.diameter * d.number("DMIN/D", above, "above 0")?;
        let mass = PI / 6.0 * least.powi(3) * d.number("dens", above, "above 0")?;
        let ln = libm::log(restitution);
        let damping = -ln / libm::hypot(PI, ln);
        let contact = PI / (2.0 * self.stiffness / mass * (1.0 - damping * damping)).sqrt();
        let step = contact / divisor;
        let by_time = d.word("CTime") != "nstep";
        let end = match by_time && d.has("Tstrain") {
            true => d.number("Tstrain", above, "above 0")?,
            false => steps * step,
        };
        let frames = d.number("NPrint", |n| n >= 1.0, "1 or more")?.min(100_000.0) as u32;
        let last = if d.geology { "NLast" } else { "MLast" };
        let detail = d.number(last, |n| n >= 0.0 && n.fract() == 0.0, "a whole number")?.min(1000.0) as u32;
        self.line(&format!("[time]\nend = {end:?}\n\n[output]\nframes = {frames}"));
        if detail > 0 {
            let time = end / f64::from(frames + 1);
            self.line(&format!("last = {{ time = {time:?}, frames = {detail} }}"));
        }
        self.used("NPrint", "output.frames");
        self.used("CTime", "which of the two ends the run");
        if by_time && d.has("Tstrain") {
            self.used("Tstrain", "time.end");
            self.left("nstep", "CTime selects Tstrain as the end of the run");
            self.left("icont", "the step follows the contacts");
        } else {
            self.used("nstep", "time.end = nstep x step of the deck");
            self.used(
                "icont",
                &format!(
                    "that step: contact time {contact:.3e} s / icont; that of trackbed follows the contacts"
                ),
            );
            self.left("Tstrain", "CTime selects nstep as the end of the run");
        }
        self.used(last, "output.last: as many frames in the last of the equal intervals");
        Ok(())
    }

    pub(super) fn rest(&mut self) -> Result<(), Failure> {
        let growth =
            "the packing is not grown again: give it by --packing, or use region and growth of [[grains]]";
        let inner = "lists grow as needed";
        let search = "the search is made when a grain may have moved too far";
        for (key, why) in [
            ("NFILL", growth),
            ("NGROWTH", growth),
            ("GROWTH", growth),
            ("isearch", search),
            ("mxnb", inner),
            ("MAXNB_W", inner),
            (
                "skin",
                "parameter of the search; the deck calls it grid size over diameter, for which 0.6 is unusual: doubtful",
            ),
            ("temperature", "not explained: doubtful"),
            (
                "BRATIO",
                "the stiffness ratio of a part of the key block to the remainder; the deck does not name the part: add [[bond.region]]",
            ),
            ("Form drag coefficient", "for water, whose level the deck has not: add [water]"),
            ("wave height", "for water, whose level the deck has not: add [water]"),
            ("wave length", "for water, whose level the deck has not: add [water]"),
            ("r1disk", "size of ice disks, which spheres have not"),
            ("r2disk", "thickness of ice disks, which spheres have not"),
            ("viscous damping coefficient", "for ice disks; grains have restitution"),
        ] {
            self.left(key, why);
        }
        if self.deck.has("wave height") {
            let (h, l) = (
                self.deck.number("wave height", |h| h >= 0.0, "0 or more")?,
                self.deck.number("wave length", |l| l > 0.0, "above 0")?,
            );
            if h > 0.142 * l {
                let why = "for water, whose level the deck has not; higher than waves of its length can be (0.142 of it): doubtful";
                self.became.retain(|(k, _, _)| *k != "wave height");
                self.left("wave height", why);
            }
        }
        Ok(())
    }
}
