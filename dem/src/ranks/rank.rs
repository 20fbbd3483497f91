//! Work of every rank.

use super::codec::{decode, encode};
use super::ghosts::{self, BodyLocation, Ghosts};
use super::halo::{self, Bounds};
use super::link::{Link, Lost};
use super::message_counters::{MessageCounters, MessageKind};
use super::partition::Partition;
use crate::engine::broad_phase::{self, Listed};
use crate::engine::model::Model;
use crate::engine::state::State;
use crate::engine::work::Work;
use crate::engine::{neighbour_list, step};
use crate::spatial::surface::NoSurface;

pub(super) struct Rank<L> {
    pub link: L,
    pub work: Work,
    pub partition: Partition,
    ghosts: Ghosts,
    /// At a search.
    pub boxes: Vec<Bounds>,
    /// Outgoing and incoming message.
    pub out: Vec<u8>,
    pub message: Vec<u8>,
    pub traffic: MessageCounters,
}

impl<L: Link> Rank<L> {
    pub fn new(link: L, work: Work) -> Rank<L> {
        Rank {
            link,
            work,
            partition: Partition::default(),
            ghosts: Ghosts::default(),
            boxes: Vec::new(),
            out: Vec::new(),
            message: Vec::new(),
            traffic: MessageCounters::default(),
        }
    }

    pub fn others(&self) -> impl Iterator<Item = usize> + use<L> {
        let own = self.link.rank();
        (0..self.link.size()).filter(move |&rank| rank != own)
    }

    pub fn send(&mut self, kind: MessageKind, to: usize) -> Result<(), Lost> {
        self.traffic.count(kind, self.out.len());
        self.link.send(to, &self.out)
    }

    pub fn receive(&mut self, from: usize) -> Result<(), Lost> {
        self.link.receive(from, &mut self.message)
    }

    /// `state` has the motion of all bodies.
    pub fn take_over(&mut self, model: &Model, state: &State, partition: Partition) -> Result<(), Lost> {
        self.partition = partition;
        self.work.follow(model, state);
        self.work.own = self.partition.of_rank(self.link.rank());
        let need = ghosts::of_lists(state, &self.work, &self.work.own);
        self.agree(&need)
    }

    /// Exchanges ghost lists.
    fn agree(&mut self, need: &[BodyLocation]) -> Result<(), Lost> {
        let size = self.link.size();
        self.ghosts.from.resize_with(size, Vec::new);
        self.ghosts.to.resize_with(size, Vec::new);
        self.ghosts.from.iter_mut().for_each(Vec::clear);
        for place in need {
            self.ghosts.from[self.partition.owner(place[0])].push(*place);
        }
        self.traffic.ghosts = need.len() as u64;
        for rank in self.others() {
            self.out.clear();
            encode(&mut self.out, &self.ghosts.from[rank]);
            self.send(MessageKind::Search, rank)?;
        }
        for rank in self.others() {
            self.receive(rank)?;
            self.ghosts.to[rank] = decode(&mut &self.message[..]).ok_or(Lost::garbled(rank))?;
        }
        Ok(())
    }

    pub fn await_ghosts(&mut self, state: &mut State) -> Result<(), Lost> {
        for rank in self.others() {
            if self.ghosts.from[rank].is_empty() {
                continue;
            }
            self.link.receive(rank, &mut self.message)?;
            let (places, rest) = (&self.ghosts.from[rank], &mut &self.message[..]);
            let read = ghosts::read_motion(&mut state.blocks, &mut self.work.members, places, rest);
            read.filter(|()| rest.is_empty()).ok_or(Lost::garbled(rank))?;
        }
        Ok(())
    }

    /// Advances by a step and sends ghosts.
    pub fn advance(&mut self, model: &Model, state: &mut State) -> Result<(), Lost> {
        step::advance(model, state, &mut self.work, &NoSurface);
        for rank in self.others() {
            if !self.ghosts.to[rank].is_empty() {
                self.out.clear();
                ghosts::write_motion(&state.blocks, &self.ghosts.to[rank], &mut self.out);
                self.send(MessageKind::Ghosts, rank)?;
            }
        }
        Ok(())
    }

    /// Largest squared displacement since the last search [m²].
    pub fn moved2(&self, state: &State) -> f64 {
        if self.work.searched.listed.is_some() {
            neighbour_list::moved2(state, &self.work)
        } else {
            f64::INFINITY
        }
    }

    pub fn bounds(&self, state: &State) -> impl Iterator<Item = Bounds> {
        state.blocks[self.work.own.clone()].iter().map(halo::bounds)
    }

    /// Rebuilds neighbour lists, after a search if pairs approached too far.
    pub fn rebuild(&mut self, model: &Model, state: &mut State, approach: f64) -> Result<(), Lost> {
        let mut approach = approach;
        if neighbour_list::exceeds_skin(model, state, approach) {
            self.search(model, state)?;
            approach = 0.0;
        }
        neighbour_list::rebuild(model, state, &mut self.work, &NoSurface, approach);
        Ok(())
    }

    fn search(&mut self, model: &Model, state: &mut State) -> Result<(), Lost> {
        let mut near = Vec::new();
        // Margin for rounding.
        let reach = 1.01 * model.skin;
        for rank in self.others() {
            let ranges = (self.work.own.clone(), self.partition.of_rank(rank));
            halo::near(&state.blocks, &self.boxes, ranges, reach, &mut near);
            self.out.clear();
            encode(&mut self.out, &near);
            ghosts::write_motion(&state.blocks, &near, &mut self.out);
            self.send(MessageKind::Search, rank)?;
        }
        self.work.halo.clear();
        for rank in self.others() {
            self.link.receive(rank, &mut self.message)?;
            let rest = &mut &self.message[..];
            let places: Vec<BodyLocation> = decode(rest).ok_or(Lost::garbled(rank))?;
            let read = ghosts::read_motion(&mut state.blocks, &mut self.work.members, &places, rest);
            read.filter(|()| rest.is_empty()).ok_or(Lost::garbled(rank))?;
            self.work.halo.extend(places);
        }
        broad_phase::search(model, state, &mut self.work, &NoSurface, Listed::All);
        let need = ghosts::of_candidates(state, &self.work, &self.work.own);
        self.agree(&need)
    }
}
