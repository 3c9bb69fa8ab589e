//! A font's bytes that stay in the application's memory.

use std::ffi::c_void;

/// Tells an application that its bytes are not used any more. `user` is what it gave with them. It must not throw.
pub type nfr_release = Option<unsafe extern "C" fn(user: *mut c_void)>;

/// Calls a release function once, when it is dropped.
pub(crate) struct Release {
    pub(crate) function: nfr_release,
    pub(crate) user: *mut c_void,
}

impl Drop for Release {
    fn drop(&mut self) {
        if let Some(function) = self.function {
            // SAFETY: the application gave both for this one call.
            unsafe { function(self.user) }
        }
    }
}

/// Bytes of the application's.
pub(crate) struct Borrowed {
    data: *const u8,
    len: usize,
    _release: Release,
}

impl Borrowed {
    /// # Safety
    ///
    /// `len` bytes can be read at `data` and do not change until `release` is dropped, which may be on any thread.
    pub(crate) unsafe fn new(data: *const u8, len: usize, release: Release) -> Self {
        Self { data, len, _release: release }
    }
}

impl AsRef<[u8]> for Borrowed {
    fn as_ref(&self) -> &[u8] {
        // SAFETY: promised to `new`.
        unsafe { std::slice::from_raw_parts(self.data, self.len) }
    }
}

// SAFETY: the bytes are only read, and the release function may be called on any thread.
unsafe impl Send for Borrowed {}
// SAFETY: as above.
unsafe impl Sync for Borrowed {}
