//! Numbers out of tensors.

use burn::tensor::kind::Basic;
use burn::tensor::{Element, Tensor, TensorData};

use nfr_convert::error::Error;

/// The `count` numbers of a tensor.
///
/// # Errors
///
/// `Unsupported` for a tensor of numbers of another type, which a device may have chosen, or of another size. Taking
/// such a tensor for an empty one would measure the error of a blank picture.
pub(super) fn values<E: Element>(data: &TensorData, count: usize) -> Result<Vec<E>, Error> {
    let (found, shape) = (data.dtype(), data.shape().clone());
    match data.try_to_vec::<E>() {
        Ok(values) if values.len() == count => Ok(values),
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

/// The error of a device that failed, from the first line of what it says.
pub(super) fn device_failed(reason: &str) -> Error {
    let first = reason.lines().next().unwrap_or_default();
    Error::Device(format!(
        "the device failed ({first}); what was saved is kept: go on with --resume, with fewer --jobs if its memory was full"
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
}
