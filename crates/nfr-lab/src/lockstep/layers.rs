//! Layers of several networks, and what is computed for each pixel of a box: `[networks, rows, columns, features]`.

use burn::module::{Module, Param};
use burn::nn::{BatchNorm, Linear};
use burn::tensor::Tensor;

use nfr::internals::network::NORM_EPSILON;

/// One dense layer of each network.
#[derive(Module, Debug)]
pub(super) struct Layers {
    /// `[networks, inputs, outputs]`.
    weight: Param<Tensor<3>>,
    /// `[networks, 1, outputs]`.
    bias: Option<Param<Tensor<3>>>,
}

/// One batch normalisation of each network.
#[derive(Module, Debug)]
pub(super) struct Norms {
    /// `[networks, 1, features]`, as is `beta`.
    gamma: Param<Tensor<3>>,
    beta: Param<Tensor<3>>,
}

impl Layers {
    /// The layers of several networks, at least one of which has it. One that has not gets zeros, as do inputs that one lacks.
    pub(super) fn stacked<'l>(layers: impl Iterator<Item = Option<&'l Linear>> + Clone) -> Self {
        let known = layers.clone().flatten();
        let [mut inputs, mut outputs] = [0; 2];
        for [i, o] in known.clone().map(|layer| layer.weight.dims()) {
            (inputs, outputs) = (inputs.max(i), o);
        }
        let with_bias = known.clone().any(|layer| layer.bias.is_some());
        let device = known.map(|layer| layer.weight.val().device()).next().unwrap_or_default();
        let zeros = |rows: usize| Tensor::<2>::zeros([rows, outputs], &device);
        let weight = |layer: Option<&Linear>| match layer.map(|layer| plain(&layer.weight)) {
            None => zeros(inputs),
            Some(weight) if weight.dims()[0] == inputs => weight,
            Some(weight) => {
                let missing = inputs - weight.dims()[0];
                Tensor::cat(vec![weight, zeros(missing)], 0)
            }
        };
        let bias = |layer: Option<&Linear>| match layer.and_then(|layer| layer.bias.as_ref()) {
            Some(bias) => plain(bias).unsqueeze(),
            None => zeros(1),
        };
        let weights = layers.clone().map(weight).collect();
        Self {
            weight: Param::from_tensor(Tensor::stack(weights, 0)),
            bias: with_bias.then(|| Param::from_tensor(Tensor::stack(layers.map(bias).collect(), 0))),
        }
    }

    /// `[networks, inputs, outputs]`.
    pub(super) fn weight(&self) -> Tensor<3> {
        self.weight.val()
    }

    /// `[networks, 1, outputs]`.
    pub(super) fn bias(&self) -> Tensor<3> {
        match &self.bias {
            Some(bias) => bias.val(),
            None => {
                let [networks, _, outputs] = self.weight.dims();
                Tensor::zeros([networks, 1, outputs], &self.weight.val().device())
            }
        }
    }

    /// Copies the layer of the network with this number.
    pub(super) fn copy_to(&self, number: usize, layer: &mut Linear) {
        let [inputs, outputs] = layer.weight.dims();
        let of_network = plain(&self.weight).slice([number..number + 1, 0..inputs, 0..outputs]);
        layer.weight = Param::from_tensor(of_network.reshape([inputs, outputs]));
        if let (Some(_), Some(bias)) = (&layer.bias, &self.bias) {
            layer.bias = Some(Param::from_tensor(row(bias, number)));
        }
    }
}

impl Norms {
    /// The batch normalisations of several networks.
    pub(super) fn stacked(norms: &[&BatchNorm]) -> Self {
        let stacked = |of: &dyn Fn(&BatchNorm) -> &Param<Tensor<1>>| {
            let rows = norms.iter().map(|norm| plain(of(norm)).unsqueeze::<2>()).collect();
            Param::from_tensor(Tensor::stack(rows, 0))
        };
        Self { gamma: stacked(&|norm| &norm.gamma), beta: stacked(&|norm| &norm.beta) }
    }

    /// Copies the normalisation of the network with this number. Its running statistics stay as they are.
    pub(super) fn copy_to(&self, number: usize, norm: &mut BatchNorm) {
        norm.gamma = Param::from_tensor(row(&self.gamma, number));
        norm.beta = Param::from_tensor(row(&self.beta, number));
    }
}

/// A parameter's numbers alone, for which no gradient is asked.
fn plain<const D: usize>(parameter: &Param<Tensor<D>>) -> Tensor<D> {
    parameter.val().detach().set_require_grad(false)
}

/// The row of the network with this number, of `[networks, 1, features]`.
fn row(rows: &Param<Tensor<3>>, number: usize) -> Tensor<1> {
    let [_, _, features] = rows.dims();
    plain(rows).slice([number..number + 1, 0..1, 0..features]).reshape([features])
}

/// Pixels `[networks, side², features]` as rows and columns. Sums over pixels are taken over the rows first, for all columns at
/// once, then over these: a sum down one long column keeps few threads of a GPU busy.
pub(super) fn in_rows(x: Tensor<3>, side: usize) -> Tensor<4> {
    let [networks, _, features] = x.dims();
    x.reshape([networks, side, side, features])
}

/// `[networks, 1, features]` for each column of a box. Its gradient is summed as [`in_rows`] says.
pub(super) fn spread(row: Tensor<3>, side: usize) -> Tensor<4> {
    let [networks, _, features] = row.dims();
    row.expand([networks, side, features]).reshape([networks, 1, side, features])
}

/// Batch normalisation with the statistics of the batch, of each network for itself.
pub(super) fn normalised(norm: &Norms, x: Tensor<4>, side: usize) -> Tensor<4> {
    let [networks, _, _, features] = x.dims();
    let count = (side * side) as f32;
    let mean = |x: Tensor<4>| (x.sum_dim(1).sum_dim(2) / count).reshape([networks, 1, features]);
    let centred = x.clone() - spread(mean(x), side);
    let variance = mean(centred.clone().square());
    let scale = norm.gamma.val() / (variance + NORM_EPSILON).sqrt();
    centred * spread(scale, side) + spread(norm.beta.val(), side)
}
