//! Reusable scratch buffers.

use std::sync::Mutex;

#[derive(Debug)]
pub struct Buffers<T>(Mutex<Vec<T>>);

impl<T> Default for Buffers<T> {
    fn default() -> Buffers<T> {
        Buffers(Mutex::new(Vec::new()))
    }
}

impl<T> Clone for Buffers<T> {
    fn clone(&self) -> Buffers<T> {
        Buffers::default()
    }
}

impl<T: Default> Buffers<T> {
    pub fn take(&self) -> T {
        self.0.lock().map(|mut b| b.pop()).ok().flatten().unwrap_or_default()
    }

    pub fn clear(&self) {
        if let Ok(mut buffers) = self.0.lock() {
            *buffers = Vec::new();
        }
    }

    pub fn give_back(&self, buffer: T) {
        if let Ok(mut buffers) = self.0.lock() {
            buffers.push(buffer);
        }
    }
}
