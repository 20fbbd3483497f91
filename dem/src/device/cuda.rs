//! CUDA device as a [`Machine`]; its libraries are loaded at run time, so the build does not need them.

use super::layout::Arguments;
use super::machine::{Call, Machine};
use bytemuck::{Pod, cast_slice, cast_slice_mut};
use cudarc::driver::{
    CudaContext, CudaFunction, CudaSlice, CudaStream, DevicePtr, DeviceRepr, DriverError, LaunchConfig,
    PinnedHostSlice, PushKernelArg,
};
use cudarc::nvrtc::{CompileError, CompileOptions, compile_ptx_with_opts};
use std::collections::HashMap;
use std::sync::Arc;

/// Threads per block, as in the launch bounds of the kernels.
const THREADS: u32 = 128;

/// Pinned download buffer [B]; larger downloads bypass it.
const LANDING: usize = 1 << 22;

/// CUDA device with the kernels of one model.
pub struct Cuda {
    stream: Arc<CudaStream>,
    kernels: HashMap<&'static str, CudaFunction>,
    buffers: Vec<Option<CudaSlice<u8>>>,
    landing: Option<PinnedHostSlice<u8>>,
    /// Device name.
    pub name: String,
}

#[repr(transparent)]
struct ByValue(Arguments);

// SAFETY: `Arguments` is `repr(C)` of plain numbers and matches the only kernel parameter.
unsafe impl DeviceRepr for ByValue {}

fn of_driver(e: DriverError) -> String {
    format!("CUDA driver: {e}")
}

impl Cuda {
    /// Returns the missing library or device, if any.
    pub fn missing() -> Option<&'static str> {
        // SAFETY: both calls only try to open a library by name.
        let (driver, compiler) =
            unsafe { (cudarc::driver::sys::is_culib_present(), cudarc::nvrtc::sys::is_culib_present()) };
        match (driver, compiler) {
            (false, _) => Some("NVIDIA driver library (libcuda) not found"),
            (_, false) => Some("CUDA run-time compiler (libnvrtc) not found"),
            _ => None,
        }
    }

    /// Compiles `text` for the first device. Requires that nothing is [missing](Cuda::missing).
    ///
    /// # Errors
    /// No device, or the kernels do not compile or load.
    pub fn new(text: &str, kernels: &[&'static str]) -> Result<Cuda, String> {
        let context = CudaContext::new(0).map_err(of_driver)?;
        let (major, minor) = context.compute_capability().map_err(of_driver)?;
        let options = CompileOptions {
            // Contraction to fused multiply-add would change bits.
            fmad: Some(false),
            options: vec![format!("--gpu-architecture=compute_{major}{minor}")],
            ..CompileOptions::default()
        };
        let code = compile_ptx_with_opts(text, options).map_err(|e| match e {
            CompileError::CompileError { log, .. } => format!("NVRTC: {}", log.to_string_lossy()),
            other => format!("NVRTC: {other}"),
        })?;
        let module = context.load_module(code).map_err(of_driver)?;
        let kernel = |&name| Ok((name, module.load_function(name).map_err(of_driver)?));
        let kernels = kernels.iter().map(kernel).collect::<Result<_, String>>()?;
        let name = context.name().map_err(of_driver)?;
        Ok(Cuda { stream: context.default_stream(), kernels, buffers: Vec::new(), landing: None, name })
    }

    /// Returns a buffer of at least `bytes`; growing discards its contents.
    fn room(&mut self, buffer: usize, bytes: usize) -> Result<&mut CudaSlice<u8>, String> {
        if self.buffers.len() <= buffer {
            self.buffers.resize_with(buffer + 1, || None);
        }
        let slot = &mut self.buffers[buffer];
        if slot.as_ref().is_none_or(|slice| slice.len() < bytes) {
            // Both may not fit. List lengths vary: margin 25 %.
            *slot = None;
            *slot = Some(self.stream.alloc_zeros((bytes + bytes / 4).max(64)).map_err(of_driver)?);
        }
        slot.as_mut().ok_or_else(|| "no buffer".to_string())
    }

    fn write<T: Pod>(&mut self, buffer: usize, data: &[T]) -> Result<(), String> {
        let bytes: &[u8] = cast_slice(data);
        let stream = self.stream.clone();
        let slice = self.room(buffer, bytes.len())?;
        if bytes.is_empty() {
            return Ok(());
        }
        stream.memcpy_htod(bytes, &mut slice.slice_mut(..bytes.len())).map_err(of_driver)
    }

    /// Writes into an existing buffer from index `from`.
    fn fill_up<T: Pod>(&mut self, buffer: usize, from: usize, data: &[T]) -> Result<(), String> {
        let (bytes, from) = (cast_slice::<T, u8>(data), from * size_of::<T>());
        let Some(Some(slice)) = self.buffers.get_mut(buffer).filter(|_| !bytes.is_empty()) else {
            return Ok(());
        };
        let mut there = slice.slice_mut(from..from + bytes.len());
        self.stream.memcpy_htod(bytes, &mut there).map_err(of_driver)
    }

    fn read<T: Pod>(&mut self, buffer: usize, from: usize, data: &mut [T]) -> Result<(), String> {
        let (bytes, from) = (cast_slice_mut::<T, u8>(data), from * size_of::<T>());
        let Some(Some(slice)) = self.buffers.get(buffer).filter(|_| !bytes.is_empty()) else { return Ok(()) };
        let wanted = slice.slice(from..from + bytes.len());
        if bytes.len() > LANDING {
            self.stream.memcpy_dtoh(&wanted, bytes).map_err(of_driver)?;
            return self.stream.synchronize().map_err(of_driver);
        }
        if self.landing.is_none() {
            // SAFETY: only bytes copied into it before are read.
            let memory = unsafe { self.stream.context().alloc_pinned_with_flags(LANDING, 0) };
            self.landing = Some(memory.map_err(of_driver)?);
        }
        let Some(landing) = &mut self.landing else { return Err("no memory".into()) };
        // Stored at the start of the pinned buffer.
        let landed = &mut landing.as_mut_slice().map_err(of_driver)?[..bytes.len()];
        self.stream.memcpy_dtoh(&wanted, landed).map_err(of_driver)?;
        self.stream.synchronize().map_err(of_driver)?;
        bytes.copy_from_slice(landed);
        Ok(())
    }
}

impl Machine for Cuda {
    fn put(&mut self, buffer: usize, numbers: &[f64]) -> Result<(), String> {
        self.write(buffer, numbers)
    }

    fn put_counts(&mut self, buffer: usize, counts: &[u32]) -> Result<(), String> {
        self.write(buffer, counts)
    }

    fn reserve(&mut self, buffer: usize, numbers: usize) -> Result<(), String> {
        self.room(buffer, numbers * size_of::<f64>()).map(|_| ())
    }

    fn reserve_counts(&mut self, buffer: usize, counts: usize) -> Result<(), String> {
        self.room(buffer, counts * size_of::<u32>()).map(|_| ())
    }

    fn fill(&mut self, buffer: usize, from: usize, numbers: &[f64]) -> Result<(), String> {
        self.fill_up(buffer, from, numbers)
    }

    fn fill_counts(&mut self, buffer: usize, from: usize, counts: &[u32]) -> Result<(), String> {
        self.fill_up(buffer, from, counts)
    }

    fn get(&mut self, buffer: usize, from: usize, numbers: &mut [f64]) -> Result<(), String> {
        self.read(buffer, from, numbers)
    }

    fn get_counts(&mut self, buffer: usize, counts: &mut [u32]) -> Result<(), String> {
        self.read(buffer, 0, counts)
    }

    fn launch(&mut self, kernel: &'static str, threads: usize, call: &Call) -> Result<(), String> {
        if threads == 0 {
            return Ok(());
        }
        let threads = u32::try_from(threads).map_err(|_| format!("{threads} threads are too many"))?;
        let address = |buffer: usize| match self.buffers.get(buffer) {
            Some(Some(slice)) => slice.device_ptr(&self.stream).0,
            _ => 0,
        };
        let arguments = ByValue(call.arguments(address));
        let function = self.kernels.get(kernel).ok_or_else(|| format!("there is no kernel {kernel}"))?;
        let grid = LaunchConfig {
            grid_dim: (threads.div_ceil(THREADS), 1, 1),
            block_dim: (THREADS, 1, 1),
            shared_mem_bytes: 0,
        };
        let mut launch = self.stream.launch_builder(function);
        launch.arg(&arguments);
        // SAFETY: the only parameter, with buffers of the sizes in its counts.
        unsafe { launch.launch(grid) }.map(|_| ()).map_err(of_driver)
    }
}
