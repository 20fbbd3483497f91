//! First rank: back end of a distributed run.

use super::codec::{decode, encode, read_numbers, write_numbers};
use super::commands::{self, Command};
use super::halo::Bounds;
use super::link::{Link, Lost};
use super::message_counters::{MessageCounters, MessageKind};
use super::partition::Partition;
use super::rank::Rank;
use super::{block_totals, state_message};
use crate::base::error::StepError;
use crate::engine::back_end::BackEnd;
use crate::engine::input::AppliedForce;
use crate::engine::model::Model;
use crate::engine::state::State;
use crate::engine::work::Work;
use crate::engine::{applied, bonds, neighbour_list, reordering, step};
use crate::spatial::surface::{Surface, SurfaceContact};

/// Steps on several ranks. The state is complete after [`BackEnd::download`].
pub struct Ranks<L: Link> {
    rank: Rank<L>,
    /// Whether the other ranks are ahead of the state.
    ahead: bool,
    /// Whether the state has the data of other ranks.
    whole: bool,
    /// Whether debonded spheres are still in contact.
    debonded: bool,
    traffic: MessageCounters,
}

impl<L: Link> Ranks<L> {
    /// Distributes a state over the ranks of `link`; each builds the model from `description`.
    ///
    /// # Errors
    /// A rank is lost, or cannot build the model.
    pub fn new(link: L, model: &Model, state: &State, description: &[u8]) -> Result<Ranks<L>, StepError> {
        let time = state.time;
        let mut ranks = Ranks {
            rank: Rank::new(link, Work::new(model, state)),
            ahead: false,
            whole: true,
            debonded: false,
            traffic: MessageCounters::default(),
        };
        ranks
            .introduce(model, description)
            .and_then(|()| ranks.distribute(model, state))
            .map_err(at(time))?;
        Ok(ranks)
    }

    fn introduce(&mut self, model: &Model, description: &[u8]) -> Result<(), Lost> {
        let rank = &mut self.rank;
        for other in rank.others() {
            rank.out.clear();
            encode(&mut rank.out, &Command::Model { bodies: model.body_count() as u64, dt: model.dt() });
            rank.out.extend_from_slice(description);
            rank.send(MessageKind::State, other)?;
        }
        for other in rank.others() {
            rank.receive(other)?;
            let problem: String = decode(&mut &rank.message[..]).ok_or(Lost::garbled(other))?;
            if !problem.is_empty() {
                return Err(Lost { rank: other, problem });
            }
        }
        Ok(())
    }

    /// Messages of all ranks up to the last download.
    pub fn traffic(&self) -> &MessageCounters {
        &self.traffic
    }

    /// Returns the numbers of searches and of neighbour-list rebuilds.
    pub fn rebuilds(&self) -> (u64, u64) {
        self.rank.work.rebuilds()
    }

    fn distribute(&mut self, model: &Model, state: &State) -> Result<(), Lost> {
        let rank = &mut self.rank;
        let partition = Partition::of(state, rank.link.size());
        for other in rank.others() {
            rank.out.clear();
            encode(&mut rank.out, &Command::Take);
            state_message::write(state, &partition, other, &mut rank.out);
            rank.send(MessageKind::State, other)?;
        }
        rank.take_over(model, state, partition)?;
        // Such large messages are rare.
        (rank.out, rank.message) = (Vec::new(), Vec::new());
        (self.ahead, self.whole, self.debonded) = (false, true, bonds::any_debonded(state));
        Ok(())
    }

    fn fetch(&mut self, state: &mut State) -> Result<(), Lost> {
        if !std::mem::take(&mut self.ahead) {
            return Ok(());
        }
        let rank = &mut self.rank;
        for other in rank.others() {
            rank.out.clear();
            encode(&mut rank.out, &Command::Give);
            rank.send(MessageKind::Order, other)?;
        }
        self.traffic = MessageCounters::default();
        for other in rank.others() {
            rank.link.receive(other, &mut rank.message)?;
            let rest = &mut &rank.message[..];
            let part = rank.partition.of_rank(other);
            let sent: MessageCounters = decode(rest).ok_or(Lost::garbled(other))?;
            state_message::read_back(state, part, rest).ok_or(Lost::garbled(other))?;
            self.traffic.add(&sent);
        }
        self.traffic.add(&rank.traffic);
        rank.message = Vec::new();
        self.whole = true;
        Ok(())
    }

    fn advance(
        &mut self,
        model: &Model,
        state: &mut State,
        applied: &[AppliedForce],
    ) -> Result<(), StepError> {
        let lost = at(state.time);
        if state.steps > 0 && state.steps.is_multiple_of(reordering::EVERY) {
            self.fetch(state).map_err(&lost)?;
            state.reorder(model);
            self.distribute(model, state).map_err(&lost)?;
        }
        if !applied.is_empty() {
            // Lever arms need present positions.
            self.fetch(state).map_err(&lost)?;
        }
        applied::add_forces(model, state, applied, &mut self.rank.work.applied)?;
        if std::mem::take(&mut self.whole) {
            state_message::restrict(state, &self.rank.work.own);
            bonds::arrange(model, state, &mut self.rank.work);
        }
        let bonded = !model.bonds.is_empty();
        let rebuild = neighbour_list::needs_rebuild(state);
        if rebuild {
            neighbour_list::adapt(model, state);
        }
        let mut make = || {
            let rank = &mut self.rank;
            for other in rank.others() {
                rank.out.clear();
                commands::write_step(state, rebuild, &rank.work.applied, &mut rank.out);
                rank.send(MessageKind::Order, other)?;
            }
            self.ahead = true;
            if rebuild {
                renew_near_list(rank, model, state)?;
            }
            rank.advance(model, state)?;
            rank.await_ghosts(state)?;
            for other in rank.others() {
                rank.link.receive(other, &mut rank.message)?;
                let part = rank.partition.of_rank(other);
                let read = block_totals::read(&mut rank.work, part, bonded, &mut &rank.message[..]);
                read.ok_or(Lost::garbled(other))?;
            }
            Ok(())
        };
        make().map_err(&lost)?;
        // Breakage is processed on the complete state, which is then distributed again.
        let look = self.debonded && state.steps.is_multiple_of(bonds::CHECK_INTERVAL);
        if bonded && (look || block_totals::any_broken(&self.rank.work)) {
            self.fetch(state).map_err(&lost)?;
            bonds::arrange(model, state, &mut self.rank.work);
            let before = bonds::parted(state);
            step::reduce_blocks(model, state, &mut self.rank.work, 0.0)?;
            return match bonds::parted(state) == before {
                true => Ok(()),
                false => self.distribute(model, state).map_err(&lost),
            };
        }
        if !applied.is_empty() {
            self.fetch(state).map_err(&lost)?;
        }
        step::reduce_blocks(model, state, &mut self.rank.work, 0.0)
    }
}

/// Rebuilds the lists of all ranks, after a search if one needs it.
fn renew_near_list<L: Link>(rank: &mut Rank<L>, model: &Model, state: &mut State) -> Result<(), Lost> {
    let mut moved2 = if state.stale { f64::INFINITY } else { rank.moved2(state) };
    rank.boxes = rank.bounds(state).collect();
    for other in rank.others() {
        rank.receive(other)?;
        let rest = &mut &rank.message[..];
        let [theirs] = read_numbers(rest).ok_or(Lost::garbled(other))?;
        moved2 = moved2.max(theirs);
        let boxes: Vec<Bounds> = decode(rest).ok_or(Lost::garbled(other))?;
        rank.boxes.extend(boxes);
    }
    rank.work.searched.surface_travel += state.wall_travel;
    let approach = match moved2 {
        far if far.is_infinite() => far,
        near => neighbour_list::approach(model, state, &rank.work, near),
    };
    for other in rank.others() {
        rank.out.clear();
        write_numbers(&mut rank.out, [approach]);
        if neighbour_list::exceeds_skin(model, state, approach) {
            encode(&mut rank.out, &rank.boxes);
        }
        rank.send(MessageKind::NearList, other)?;
    }
    rank.rebuild(model, state, approach)
}

fn at(time: f64) -> impl Fn(Lost) -> StepError {
    move |lost| StepError::Rank { time, rank: lost.rank, problem: lost.problem }
}

impl<L: Link> BackEnd for Ranks<L> {
    fn upload(&mut self, model: &Model, state: &State) -> Result<(), StepError> {
        self.distribute(model, state).map_err(at(state.time))
    }

    fn step<S: Surface>(
        &mut self,
        model: &Model,
        state: &mut State,
        surface: &S,
        applied: &[AppliedForce],
    ) -> Result<(), StepError> {
        // The model has no surface material.
        if surface.is_empty() { self.advance(model, state, applied) } else { Err(StepError::SurfaceMaterial) }
    }

    fn download(&mut self, _: &Model, state: &mut State) -> Result<(), StepError> {
        let time = state.time;
        self.fetch(state).map_err(at(time))
    }

    fn surface_contacts(&self) -> &[SurfaceContact] {
        &[]
    }
}

impl<L: Link> Drop for Ranks<L> {
    fn drop(&mut self) {
        dismiss(&mut self.rank.link);
    }
}

/// Ends [`serve`](super::serve) on all other ranks, if no [`Ranks`] does.
pub fn dismiss(link: &mut impl Link) {
    let mut end = Vec::new();
    encode(&mut end, &Command::End);
    let own = link.rank();
    for other in (0..link.size()).filter(|&other| other != own) {
        // Lost ranks are ignored.
        _ = link.send(other, &end);
    }
}
