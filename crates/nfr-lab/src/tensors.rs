//! Numbers out of tensors.

use burn::tensor::kind::Basic;
use burn::tensor::{Element, Tensor, TensorData};

use nfr_convert::error::Error;

/// The `count` numbers of a tensor.
///
/// # Errors
///
/// `Unsupported` for a tensor of numbers of another type, which a device may have chosen, or of another size; `Device` for one
/// without its numbers, as a lost device gives. Taking such a tensor for an empty one would measure the error of a blank picture.
pub(super) fn values<E: Element>(data: &TensorData, count: usize) -> Result<Vec<E>, Error> {
    let (found, shape) = (data.dtype(), data.shape().clone());
    match data.try_to_vec::<E>() {
        Ok(values) if values.len() == count => Ok(values),
        _ if found == E::dtype() && shape.num_elements() == count => {
            Err(device_failed("it gave no numbers back, as one that is lost does"))
        }
        _ => Err(Error::Unsupported(format!(
            "a tensor of {shape:?} numbers of type {found:?} where {count} of type {:?} are needed; choose another device",
            E::dtype()
        ))),
    }
}

/// A tensor's numbers from its device, which is waited for.
///
/// # Errors
///
/// `Device` if the device fails.
pub(super) fn fetch<const D: usize, K: Basic>(tensor: Tensor<D, K>) -> Result<TensorData, Error> {
    tensor.try_into_data().map_err(|error| device_failed(&error.to_string()))
}

/// The error of a device that failed, from the first line of what it says and of each cause.
pub(super) fn device_failed(reason: &str) -> Error {
    let without_trace = reason.split("\nBacktrace").next().unwrap_or_default();
    let causes = without_trace.split("Caused by:").filter_map(|cause| cause.trim().lines().next());
    let causes: Vec<&str> = causes.map(str::trim).filter(|cause| !cause.is_empty()).collect();
    Error::Device(format!(
        "the device failed ({}); what was saved is kept: go on with --resume, with fewer --jobs or --together if its memory was full",
        causes.join(": ")
    ))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_another_type_or_count_are_an_error() {
        let data = || TensorData::from([[0.5f32, 1.0], [2.0, 3.0]]);
        assert_eq!(values::<f32>(&data(), 4).unwrap(), [0.5, 1.0, 2.0, 3.0]);
        assert!(
            matches!(values::<f32>(&data(), 9), Err(Error::Unsupported(why)) if why.contains("9 of type"))
        );
        let wide = TensorData::from([0.5f64, 1.0]);
        assert!(matches!(values::<f32>(&wide, 2), Err(Error::Unsupported(why)) if why.contains("F64")));
    }

    #[test]
    fn a_failure_is_told_with_its_causes_in_a_line() {
        let told = |reason: &str| device_failed(reason).to_string();
        assert!(
            told("wgpu error: Out of Memory\n at 7")
                .starts_with("the device failed (wgpu error: Out of Memory); ")
        );
        let caused = told(
            "An error\nCaused by:\n  the memory\n  is full\nCaused by:\n  nothing\nBacktrace:\n0: f\nCaused by:\n1: g",
        );
        assert!(caused.starts_with("the device failed (An error: the memory: nothing); "), "{caused}");
        assert_eq!(caused.lines().count(), 1);
    }
}
