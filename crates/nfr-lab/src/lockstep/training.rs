//! Training networks in lockstep.

use super::{Lockstep, LockstepSamples};
use crate::implicit::{Implicit, ImplicitConfig};
use crate::network_training::{TrainedNetwork, TrainingRun, train};
use crate::samples::{TrainingSample, likeliest};
use crate::train::TrainingSchedule;
use nfr_convert::error::Error;

/// Trains a network for each of some glyphs, from their bitmaps and of these configurations, which [can join](super::can_join).
/// Each is what [`train_implicit`](crate::network_training::train_implicit) gives, up to rounding.
///
/// # Errors
///
/// As the checkpoint's; `InvalidParameter` for bitmaps of different sizes; `Device` for a device that fails, `Unsupported` for one
/// whose numbers cannot be read.
pub fn train_in_lockstep(
    members: &[(Vec<TrainingSample>, ImplicitConfig)],
    schedule: &TrainingSchedule,
    run: TrainingRun<'_>,
) -> Result<Vec<TrainedNetwork<Implicit>>, Error> {
    let new = |(_, config): &(Vec<TrainingSample>, ImplicitConfig)| {
        Implicit::new(*config, schedule.seed, run.device)
    };
    let networks: Vec<Implicit> = members.iter().map(new).collect();
    let set = LockstepSamples::new(members, &networks, run.device)?;
    let lockstep = Lockstep::new(&networks);
    let training = train(lockstep, schedule, set.len(), |numbers| set.batch(numbers[0]).clone(), run)?;
    let mut drawn = vec![Vec::new(); members.len()];
    for batch in set.batches() {
        let scores = training.network.forward(batch);
        let [_, pixels, classes] = scores.dims();
        for (number, drawn) in drawn.iter_mut().enumerate() {
            let own = scores.clone().slice([number..number + 1, 0..pixels, 0..classes]);
            drawn.push(likeliest(own.reshape([pixels, classes]), batch.side)?);
        }
    }
    let finished = training.histories.into_iter().zip(drawn).enumerate();
    let of_member = finished.map(|(number, (history, drawn))| TrainedNetwork {
        operations: set.operations()[number] as u64 * history.len() as u64,
        network: training.network.network(number, members[number].1, run.device),
        history,
        drawn,
    });
    Ok(of_member.collect())
}
