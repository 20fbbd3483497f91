//! Random numbers for tests: PCG64 (XSL-RR 128/64; O'Neill 2014), as NumPy's `default_rng`, to repeat
//! reference studies.

pub struct Random {
    state: u128,
    increment: u128,
}

impl Random {
    pub fn new(seed: u64) -> Random {
        let mut random = Random { state: 0, increment: (u128::from(seed) << 1) | 1 };
        random.next();
        random
    }

    /// NumPy's `default_rng(3)`, from the reference study of the inverse map.
    pub fn numpy_seed_3() -> Random {
        Random {
            state: 323_726_261_719_206_589_602_543_583_274_561_722_519,
            increment: 222_003_063_171_874_261_427_395_693_950_637_096_479,
        }
    }

    fn next(&mut self) -> u64 {
        const MULTIPLIER: u128 = 0x2360_ED05_1FC6_5DA4_4385_DF64_9FCC_F645;
        self.state = self.state.wrapping_mul(MULTIPLIER).wrapping_add(self.increment);
        let folded = (self.state >> 64) as u64 ^ self.state as u64;
        folded.rotate_right((self.state >> 122) as u32)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in [−1, 1).
    pub fn symmetric(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }
}
