//! Pointers from C: checked for NULL, else taken on trust.

use crate::status::Failure;

/// What a pointer to a handle or a value refers to.
///
/// # Safety
///
/// The pointer is NULL, or what it points to is valid and is not changed while the reference is used.
pub(crate) unsafe fn shared<'a, T>(pointer: *const T, name: &'static str) -> Result<&'a T, Failure> {
    // SAFETY: the caller's promise.
    unsafe { pointer.as_ref() }.ok_or(Failure::Null(name))
}

/// What a pointer to a handle refers to, to be changed.
///
/// # Safety
///
/// The pointer is NULL, or what it points to is valid and nothing else uses it while the reference is used.
pub(crate) unsafe fn exclusive<'a, T>(pointer: *mut T, name: &'static str) -> Result<&'a mut T, Failure> {
    // SAFETY: the caller's promise.
    unsafe { pointer.as_mut() }.ok_or(Failure::Null(name))
}

/// Where a result is written. The memory may be uninitialised, so that no reference to it is made.
pub(crate) struct Out<T>(*mut T);

impl<T> Out<T> {
    /// # Safety
    ///
    /// The pointer is NULL, or a `T` can be written there as long as this value lives.
    pub(crate) unsafe fn new(pointer: *mut T, name: &'static str) -> Result<Self, Failure> {
        if pointer.is_null() { Err(Failure::Null(name)) } else { Ok(Self(pointer)) }
    }

    pub(crate) fn set(&self, value: T) {
        // SAFETY: whoever made this value promised it.
        unsafe { self.0.write(value) }
    }
}

/// Bytes to read.
///
/// # Safety
///
/// `data` is NULL, or `len` bytes can be read there and do not change while the slice is used.
pub(crate) unsafe fn bytes<'a>(data: *const u8, len: usize) -> Result<&'a [u8], Failure> {
    check(data, len, "data")?;
    // SAFETY: the caller's promise; the length was checked.
    Ok(unsafe { std::slice::from_raw_parts(data, len) })
}

/// Bytes to write; NULL for none.
///
/// # Safety
///
/// `pixels` is NULL, or `len` bytes can be written there and nothing else uses them while the slice is used.
pub(crate) unsafe fn buffer<'a>(pixels: *mut u8, len: usize) -> Result<&'a mut [u8], Failure> {
    if len == 0 {
        return Ok(&mut []);
    }
    check(pixels, len, "pixels")?;
    // SAFETY: the caller's promise; the length was checked. The renderer only writes to them.
    Ok(unsafe { std::slice::from_raw_parts_mut(pixels, len) })
}

fn check(data: *const u8, len: usize, name: &'static str) -> Result<(), Failure> {
    if data.is_null() {
        return Err(Failure::Null(name));
    }
    // More than any object has; a slice must not be longer.
    if isize::try_from(len).is_err() {
        return Err(Failure::Argument("a length in bytes is larger than any memory"));
    }
    Ok(())
}
