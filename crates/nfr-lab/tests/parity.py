"""The paper's two networks in JAX, trained as `nfr lab` trains them in burn, to compare what loss both end at.

    python3 -m venv target/jax && target/jax/bin/pip install jax pillow
    cargo run --release --bin nfr -- lab truth fonts/LiberationSerif-Regular.ttf --out out/truth
    for seed in 1 2 3 4 5 6; do for model in implicit masked; do
        cargo run --release --bin nfr -- lab $model fonts/LiberationSerif-Regular.ttf --text a --seed $seed \\
            --epochs 60 --jobs 1 --out out/parity/$seed
    done; done
    target/jax/bin/python tests/parity.py out/truth out/parity/?

It is written from the description of the networks, not from the Rust code, uses JAX's own random numbers, and
fails if the mean final loss over the seeds differs by more than a fifth. Sixty epochs are enough to tell: later, when a
glyph is memorised, losses of one program differ by an order of magnitude from seed to seed. It takes a minute and is not
part of the tests.
"""

import argparse
import csv
import json
import pathlib
import sys
import time

import jax
import jax.numpy as jnp
import numpy as np
from PIL import Image

TOLERANCE = 0.2
CLASSES = 21
EXPONENTS = 12.0 * np.arange(32) / 31


def encode(value):
    angles = 2.0**EXPONENTS * np.pi * value
    return np.concatenate([[value], np.stack([np.sin(angles), np.cos(angles)], 1).ravel()])


def inputs(side):
    axis = np.stack([encode(-1 + (2 * k + 1) / side) for k in range(side)])
    rows, columns = np.repeat(axis, side, 0), np.tile(axis, (side, 1))
    return np.concatenate([rows, columns], 1).astype(np.float32)


def glorot(key, fan_in, fan_out):
    limit = np.sqrt(6 / (fan_in + fan_out))
    return {"w": jax.random.uniform(key, (fan_in, fan_out), minval=-limit, maxval=limit), "b": jnp.zeros(fan_out)}


def dense(layer, x):
    return x @ layer["w"] + layer["b"]


def adam(lossfn, keras):
    """One step of Adam as Kingma and Ba, PyTorch and burn have it. Keras, which the paper used, adds epsilon to the
    uncorrected root."""

    @jax.jit
    def step(state, rate, *batch):
        weights, first, second, time_ = state
        loss, gradient = jax.value_and_grad(lossfn)(weights, *batch)
        time_ = time_ + 1
        first = jax.tree.map(lambda m, g: 0.9 * m + 0.1 * g, first, gradient)
        second = jax.tree.map(lambda v, g: 0.999 * v + 0.001 * g * g, second, gradient)
        rate, correction = rate / (1 - 0.9**time_), jnp.sqrt(1 - 0.999**time_)
        epsilon = 1e-7 / correction if keras else 1e-7
        weights = jax.tree.map(lambda w, m, v: w - rate * m / (jnp.sqrt(v) / correction + epsilon), weights, first, second)
        return (weights, first, second, time_), loss

    return step


def start(weights):
    zeros = jax.tree.map(jnp.zeros_like, weights)
    return (weights, zeros, zeros, 0.0)


class Implicit:
    def __init__(self, settings, squares, key, keras):
        width, latent, hidden = settings["width"], settings["latent"], settings["encoder"]
        place, number = 2 * 65, 65
        shapes = [(number, hidden)] + 4 * [(hidden, hidden)] + [(hidden, latent)]
        shapes += [(place + latent, width)] + 4 * [(width, width)] + [(width + latent, width)]
        shapes += 5 * [(width, width)] + [(width, CLASSES)]
        keys = jax.random.split(key, len(shapes))
        norms = [{"gamma": jnp.ones(width), "beta": jnp.zeros(width)} for _ in range(3)]
        self.weights = {"layers": [glorot(k, *shape) for k, shape in zip(keys, shapes)], "norms": norms}
        self.batches = []
        for k, square in enumerate(squares):
            side = square.shape[0]
            classes = np.floor(square.ravel() * (CLASSES - 1) / 255.0).astype(int)
            size = encode(k / len(squares)).astype(np.float32)[None]
            self.batches.append((inputs(side), size, np.eye(CLASSES, dtype=np.float32)[classes]))
        self.step = adam(self.loss, keras)
        self.batch = 1

    @staticmethod
    def loss(weights, place, size, classes):
        layers, norms = weights["layers"], weights["norms"]

        def normalised(norm, x):
            mean, variance = x.mean(0), x.var(0)
            return norm["gamma"] * (x - mean) / jnp.sqrt(variance + 1e-3) + norm["beta"]

        z = size
        for k in range(5):
            z = jax.nn.relu(dense(layers[k], z))
        z = jnp.tanh(dense(layers[5], z))
        z = jnp.broadcast_to(z, (place.shape[0], z.shape[1]))
        trunk = layers[6:]
        x = jax.nn.relu(dense(trunk[0], jnp.concatenate([place, z], 1)))
        x = normalised(norms[0], jax.nn.relu(dense(trunk[1], x)))
        for k in (2, 3, 4):
            x = x + jax.nn.relu(dense(trunk[k], x))
        x = normalised(norms[1], x)
        x = jax.nn.relu(dense(trunk[5], jnp.concatenate([x, z], 1)))
        for k in (6, 7, 8):
            x = x + jax.nn.relu(dense(trunk[k], x))
        x = normalised(norms[2], x)
        for k in (9, 10):
            x = x + jax.nn.relu(dense(trunk[k], x))
        p = jnp.clip(jax.nn.softmax(dense(trunk[11], x)), 1e-6, 1 - 1e-6)
        return -(classes * (1 - p) ** 6 * jnp.log(p)).sum(1).mean()

    def args(self, numbers):
        return self.batches[numbers[0]]

    @staticmethod
    def rates(settings):
        fifths = [(1e-3, 1e-5), (1e-4, 1e-6), (5e-5, 1e-7), (1e-5, 1e-8), (1e-6, 1e-9)]
        epochs = settings["implicit_epochs"]
        lengths = 4 * [epochs // 5] + [epochs - 4 * (epochs // 5)]
        return [a * (b / a) ** (k / n) for (a, b), n in zip(fifths, lengths) for k in range(n)]


class Masked:
    def __init__(self, settings, squares, key, keras):
        side = squares[-1].shape[0]
        widths = [len(squares)] + settings["masked_widths"] + [side * side]
        keys = jax.random.split(key, len(widths))
        self.weights = [glorot(k, *shape) for k, shape in zip(keys, zip(widths, widths[1:]))]
        truth, mask = [], []
        for square in squares:
            small = square.shape[0]
            copies = np.full(small, side // small)
            copies[np.floor(np.linspace(0, small - 1, side % small)).astype(int)] += 1
            index = np.repeat(np.arange(small), copies)
            truth.append(square[np.ix_(index, index)].ravel() / 255.0)
            kept = np.concatenate([[True], index[1:] != index[:-1]])
            mask.append(np.outer(kept, kept).ravel())
        self.truth, self.mask = np.float32(truth), np.float32(mask)
        self.hot = np.eye(len(squares), dtype=np.float32)
        self.step = adam(self.loss, keras)
        self.batch = 32

    @staticmethod
    def loss(weights, hot, truth, mask):
        x = hot
        for layer in weights[:-1]:
            x = jax.nn.relu(dense(layer, x))
        error = (jax.nn.sigmoid(dense(weights[-1], x)) - truth) * mask
        return (error**2).sum() / mask.sum() / hot.shape[0]

    def args(self, numbers):
        return self.hot[numbers], self.truth[numbers], self.mask[numbers]

    @staticmethod
    def rates(settings):
        period = settings["masked_period"]
        return [[5e-4, 1e-5][epoch // period % 2] for epoch in range(settings["masked_epochs"])]


def train(model, settings, squares, seed, keras):
    network = model(settings, squares, jax.random.key(seed), keras)
    order = np.random.default_rng(seed)
    state, begin = start(network.weights), time.time()
    for rate in model.rates(settings):
        numbers = order.permutation(len(squares))
        batches = [numbers[k : k + network.batch] for k in range(0, len(numbers), network.batch)]
        losses = []
        for batch in batches:
            state, loss = network.step(state, rate, *network.args(batch))
            losses.append(loss)
        loss = float(np.mean(losses))
    return loss, time.time() - begin


def burn(run, model):
    """The last loss and the time of the one training of a model under a directory, and its settings."""
    (path,) = sorted(pathlib.Path(run).glob(f"{model}/*/*/history.csv"))
    with open(path, newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    settings = json.loads((pathlib.Path(run) / "settings.json").read_text())
    return float(rows[-1]["loss"]), sum(float(row["seconds"]) for row in rows), settings, path.parent.name


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("truth", type=pathlib.Path, help="what `nfr lab truth` wrote")
    parser.add_argument("runs", nargs="+", help="what `nfr lab implicit` and `masked` wrote, a directory for each seed")
    networks = {"implicit": Implicit, "masked": Masked}
    parser.add_argument("--only", choices=networks, help="compare one of the networks")
    parser.add_argument("--keras", action="store_true", help="add epsilon where Keras does, which differs from burn")
    args = parser.parse_args()
    failed = False
    for name in [args.only] if args.only else networks:
        model = networks[name]
        of_burn = [burn(run, name) for run in args.runs]
        settings, glyph = of_burn[0][2:]
        sides = settings["sides"]
        squares = [255.0 - np.asarray(Image.open(args.truth / str(side) / f"{glyph}.png")) for side in sides]
        of_jax = [train(model, settings, squares, seed, args.keras) for seed in range(1, len(of_burn) + 1)]
        means = [np.mean([run[0] for run in runs]) for runs in (of_burn, of_jax)]
        ratio = means[0] / means[1]
        for framework, runs, mean in (("burn", of_burn, means[0]), ("JAX", of_jax, means[1])):
            losses = ", ".join(f"{run[0]:.4g}" for run in runs)
            print(f"{name:8} {framework:4} loss {mean:.4g} (of {losses}), {np.mean([run[1] for run in runs]):.1f} s each")
        within = abs(ratio - 1) <= TOLERANCE
        failed |= not within
        print(f"{name:8} burn / JAX {ratio:.3f}: {'within' if within else 'NOT within'} {TOLERANCE:.0%}")
    sys.exit(failed)


if __name__ == "__main__":
    main()
