//! Device compiled by the system's C compiler: kernels as a library, with sequential threads.
//!
//! With feature `cuda` and `TRACKBED_DEVICE=cuda`, the tests use a CUDA device.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicU32, Ordering};
use trackbed_dem::Model;
use trackbed_dem::device::{Arguments, Call, Machine};

type Kernel = unsafe extern "C" fn(*const Arguments, u32, i32);

enum Buffer {
    Numbers(Vec<f64>),
    Counts(Vec<u32>),
}

/// Threads run forwards and backwards alternately, which reveals dependence on their order.
struct CMachine {
    library: libloading::Library,
    folder: PathBuf,
    buffers: Vec<Buffer>,
    launches: u32,
}

/// Whether a device or C compiler exists; prints a note if not.
pub fn device_is_there() -> bool {
    if on_cuda() {
        return true;
    }
    let there = Command::new("cc").arg("--version").output().is_ok_and(|o| o.status.success());
    if !there {
        eprintln!("skipped: no C compiler (cc) on this machine, so the text of the kernels is not run");
    }
    there
}

fn on_cuda() -> bool {
    std::env::var("TRACKBED_DEVICE").is_ok_and(|v| v == "cuda")
}

pub struct TestMachine {
    machine: Box<dyn Machine>,
    /// Numbers and counts read.
    pub read: usize,
}

impl TestMachine {
    pub fn new(text: &str, model: &Model) -> TestMachine {
        let machine = if on_cuda() { cuda(text, model) } else { Box::new(CMachine::new(text)) };
        crate::device_changes::report_loaded();
        TestMachine { machine, read: 0 }
    }
}

#[cfg(feature = "cuda")]
fn cuda(text: &str, model: &Model) -> Box<dyn Machine> {
    let kernels = trackbed_dem::device::kernels(model);
    Box::new(trackbed_dem::device::Cuda::new(text, kernels).unwrap())
}

#[cfg(not(feature = "cuda"))]
fn cuda(_: &str, _: &Model) -> Box<dyn Machine> {
    panic!("TRACKBED_DEVICE=cuda needs the feature `cuda`")
}

impl Machine for TestMachine {
    fn put(&mut self, buffer: usize, numbers: &[f64]) -> Result<(), String> {
        self.machine.put(buffer, numbers)
    }

    fn put_counts(&mut self, buffer: usize, counts: &[u32]) -> Result<(), String> {
        self.machine.put_counts(buffer, counts)
    }

    fn reserve(&mut self, buffer: usize, numbers: usize) -> Result<(), String> {
        self.machine.reserve(buffer, numbers)
    }

    fn reserve_counts(&mut self, buffer: usize, counts: usize) -> Result<(), String> {
        self.machine.reserve_counts(buffer, counts)
    }

    fn fill(&mut self, buffer: usize, from: usize, numbers: &[f64]) -> Result<(), String> {
        self.machine.fill(buffer, from, numbers)
    }

    fn fill_counts(&mut self, buffer: usize, from: usize, counts: &[u32]) -> Result<(), String> {
        self.machine.fill_counts(buffer, from, counts)
    }

    fn get(&mut self, buffer: usize, from: usize, numbers: &mut [f64]) -> Result<(), String> {
        self.read += numbers.len();
        self.machine.get(buffer, from, numbers)
    }

    fn get_counts(&mut self, buffer: usize, counts: &mut [u32]) -> Result<(), String> {
        self.read += counts.len();
        self.machine.get_counts(buffer, counts)
    }

    fn launch(&mut self, kernel: &'static str, threads: usize, call: &Call) -> Result<(), String> {
        self.machine.launch(kernel, threads, call)
    }
}

impl CMachine {
    fn new(text: &str) -> CMachine {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name =
            format!("trackbed-kernels-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let folder = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&folder).unwrap();
        let (source, library) = (folder.join("kernels.c"), folder.join("kernels.so"));
        std::fs::write(&source, text).unwrap();
        compile(&source, &library);
        // SAFETY: the library was just compiled, and loading it runs no code.
        let library = unsafe { libloading::Library::new(&library) }.unwrap();
        CMachine { library, folder, buffers: Vec::new(), launches: 0 }
    }

    fn set(&mut self, buffer: usize, to: Buffer) {
        while self.buffers.len() <= buffer {
            self.buffers.push(Buffer::Numbers(Vec::new()));
        }
        self.buffers[buffer] = to;
    }
}

fn compile(source: &Path, library: &Path) {
    let options = [
        "-std=c11",
        "-O2",
        "-ffp-contract=off",
        "-fno-math-errno",
        "-Wall",
        "-Wno-unused",
        "-Werror",
        "-shared",
    ];
    let done =
        Command::new("cc").args(options).args(["-fPIC", "-o"]).args([library, source]).arg("-lm").output();
    let done = done.unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}

impl Drop for CMachine {
    fn drop(&mut self) {
        _ = std::fs::remove_dir_all(&self.folder);
    }
}

impl Machine for CMachine {
    fn put(&mut self, buffer: usize, numbers: &[f64]) -> Result<(), String> {
        self.set(buffer, Buffer::Numbers(numbers.to_vec()));
        Ok(())
    }

    fn put_counts(&mut self, buffer: usize, counts: &[u32]) -> Result<(), String> {
        self.set(buffer, Buffer::Counts(counts.to_vec()));
        Ok(())
    }

    fn reserve(&mut self, buffer: usize, numbers: usize) -> Result<(), String> {
        // Reading before writing spoils the result.
        self.set(buffer, Buffer::Numbers(vec![f64::NAN; numbers]));
        Ok(())
    }

    fn reserve_counts(&mut self, buffer: usize, counts: usize) -> Result<(), String> {
        self.set(buffer, Buffer::Counts(vec![0x00ab_cdef; counts]));
        Ok(())
    }

    fn fill(&mut self, buffer: usize, from: usize, numbers: &[f64]) -> Result<(), String> {
        match &mut self.buffers[buffer] {
            Buffer::Numbers(own) => own[from..from + numbers.len()].copy_from_slice(numbers),
            Buffer::Counts(_) => return Err(format!("buffer {buffer} holds counts")),
        }
        Ok(())
    }

    fn fill_counts(&mut self, buffer: usize, from: usize, counts: &[u32]) -> Result<(), String> {
        match &mut self.buffers[buffer] {
            Buffer::Counts(own) => own[from..from + counts.len()].copy_from_slice(counts),
            Buffer::Numbers(_) => return Err(format!("buffer {buffer} holds numbers")),
        }
        Ok(())
    }

    fn get(&mut self, buffer: usize, from: usize, numbers: &mut [f64]) -> Result<(), String> {
        match &self.buffers[buffer] {
            Buffer::Numbers(own) => numbers.copy_from_slice(&own[from..]),
            Buffer::Counts(_) => return Err(format!("buffer {buffer} holds counts")),
        }
        Ok(())
    }

    fn get_counts(&mut self, buffer: usize, counts: &mut [u32]) -> Result<(), String> {
        match &self.buffers[buffer] {
            Buffer::Counts(own) => counts.copy_from_slice(&own[..counts.len()]),
            Buffer::Numbers(_) => return Err(format!("buffer {buffer} holds numbers")),
        }
        Ok(())
    }

    fn launch(&mut self, kernel: &'static str, threads: usize, call: &Call) -> Result<(), String> {
        let addresses: Vec<u64> = self
            .buffers
            .iter_mut()
            .map(|b| match b {
                Buffer::Numbers(n) => n.as_mut_ptr() as u64,
                Buffer::Counts(n) => n.as_mut_ptr() as u64,
            })
            .collect();
        let arguments = call.arguments(|buffer| addresses.get(buffer).copied().unwrap_or(0));
        self.launches += 1;
        // SAFETY: the function has this signature and stays within the buffers laid out by the device.
        unsafe {
            let kernel = self.library.get::<Kernel>(kernel.as_bytes()).map_err(|e| e.to_string())?;
            kernel(&arguments, threads as u32, (self.launches % 4 > 1) as i32);
        }
        Ok(())
    }
}
