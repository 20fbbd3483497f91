//! Ranks started by `mpirun`, via rsmpi.
//!
//! `mpirun` ends all ranks soon after a death (OpenMPI 4.1: about 0.1 s), so the loss is reported at once.

use super::origin::quoted;
use ::mpi::environment::Universe;
use ::mpi::request::{Request, StaticScope};
use ::mpi::topology::SimpleCommunicator;
use ::mpi::traits::*;
use ::mpi::{Threading, initialize_with_threading};
use std::collections::VecDeque;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use trackbed_dem::ranks::{Link, Lost};
use trackbed_io::failure::Failure;
use trackbed_io::message;
use trackbed_io::system;

/// MPI counts have 31 bits [bytes].
const PIECE: usize = 1 << 30;

/// Polls before yielding a CPU that is not oversubscribed, and before sleeping.
const LOOKS: u32 = 2000;
const AWAKE: Duration = Duration::from_millis(20);
const NAP: Duration = Duration::from_micros(100);

const WATCH: Duration = Duration::from_millis(20);

/// Longest wait for the report of lower ranks.
const PARTING: Duration = Duration::from_secs(2);

const NAME: usize = 64;

/// All ranks.
pub struct World {
    universe: Option<Universe>,
    peers: Arc<Vec<Peer>>,
    lost: Arc<AtomicBool>,
}

#[derive(Clone, Debug)]
struct Peer {
    machine: String,
    process: u32,
    here: bool,
}

impl Peer {
    fn has_ended(&self) -> bool {
        self.here && system::has_ended(self.process)
    }
}

/// Joins the ranks of `mpirun`, if any.
///
/// # Errors
/// MPI failures.
pub fn join() -> Result<Option<World>, Failure> {
    // Set by OpenMPI, MPICH and derivatives. Otherwise MPI would start for one process.
    let started =
        ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"].iter().any(|v| std::env::var_os(v).is_some());
    if !started {
        return Ok(None);
    }
    // Otherwise OpenMPI kills a process that reads memory of a killed rank.
    const COPY: &str = "OMPI_MCA_btl_vader_single_copy_mechanism";
    if std::env::var_os(COPY).is_none() {
        // SAFETY: no other thread uses the environment yet.
        unsafe { std::env::set_var(COPY, "none") };
    }
    let failed =
        || Failure::Other("MPI: found no thread support, expected MPI_THREAD_SERIALIZED or more".into());
    let (universe, threading) = initialize_with_threading(Threading::Serialized).ok_or_else(failed)?;
    if threading < Threading::Serialized {
        return Err(failed());
    }
    let peers = peers(&universe.world());
    Ok((peers.len() > 1).then(|| World {
        universe: Some(universe),
        peers: Arc::new(peers),
        lost: Arc::default(),
    }))
}

fn peers(world: &SimpleCommunicator) -> Vec<Peer> {
    let mut own = [0_u8; NAME + 4];
    system::host_name(&mut own[..NAME]);
    own[NAME..].copy_from_slice(&std::process::id().to_le_bytes());
    let mut all = vec![0_u8; own.len() * world.size() as usize];
    world.all_gather_into(&own[..], &mut all[..]);
    let peer = |bytes: &[u8]| {
        let (name, process) = bytes.split_at(NAME);
        let end = name.iter().position(|b| *b == 0).unwrap_or(NAME);
        Peer {
            machine: String::from_utf8_lossy(&name[..end]).into_owned(),
            process: u32::from_le_bytes([process[0], process[1], process[2], process[3]]),
            here: name == &own[..NAME],
        }
    };
    all.chunks_exact(own.len()).map(peer).collect()
}

impl World {
    /// Runs `lead` on the first rank, `follow` on others; `out`: results directory.
    ///
    /// # Errors
    /// Failures of the first rank.
    pub fn share(
        mut self,
        lead: impl FnOnce(Box<dyn Link>) -> Result<(), Failure>,
        follow: impl FnOnce(Box<dyn Link>) -> Result<(), Lost>,
        out: &Path,
    ) -> Result<(), Failure> {
        let Some(universe) = &self.universe else { return Ok(()) };
        let world = universe.world();
        let rank = world.rank() as usize;
        let link = Box::new(Mpi {
            world,
            rank,
            peers: self.peers.clone(),
            lost: self.lost.clone(),
            out: quoted(out),
            looks: if self.crowded() { 1 } else { LOOKS },
            sent: VecDeque::new(),
            spare: Vec::new(),
        });
        let outcome = if rank == 0 {
            lead(link)
        } else {
            // The first rank ends the run; others detect its loss.
            for signal in system::stop_signals() {
                _ = signal_hook::flag::register(signal, Arc::default());
            }
            follow(link).map_err(|lost| Failure::Other(lost.to_string()))
        };
        // Finalising MPI would block.
        let lost = self.lost.load(Ordering::Relaxed);
        if outcome.is_err() && (rank > 0 || lost) {
            // Lower ranks must not report this rank as lost.
            let begun = Instant::now();
            while lost && self.peers[..rank].iter().any(|peer| !peer.has_ended()) && begun.elapsed() < PARTING
            {
                std::thread::sleep(WATCH);
            }
            std::process::exit(1);
        }
        drop(self.universe.take());
        outcome
    }

    fn crowded(&self) -> bool {
        self.peers.iter().filter(|peer| peer.here).count() > system::processors()
    }
}

type Sent = Request<'static, [u8], StaticScope>;

struct Mpi {
    world: SimpleCommunicator,
    rank: usize,
    peers: Arc<Vec<Peer>>,
    lost: Arc<AtomicBool>,
    out: String,
    looks: u32,
    /// In transit, and free buffers.
    sent: VecDeque<(Sent, Vec<u8>)>,
    spare: Vec<Vec<u8>>,
}

// SAFETY: handles; MPI is initialised for serialised calls, and a link has one owner.
unsafe impl Send for Mpi {}

impl Mpi {
    fn settle(&mut self) {
        while let Some((request, room)) = self.sent.pop_front() {
            match request.test() {
                Ok(_) => self.spare.push(room),
                Err(request) => return self.sent.push_front((request, room)),
            }
        }
    }

    fn post(&mut self, to: usize, piece: &[u8]) {
        let mut room = self.spare.pop().unwrap_or_default();
        room.clear();
        room.extend_from_slice(piece);
        // SAFETY: the buffer stays in `sent`, untouched, until sent, or forever.
        let bytes: &'static [u8] = unsafe { std::slice::from_raw_parts(room.as_ptr(), room.len()) };
        let request = self.world.process_at_rank(to as i32).immediate_send(StaticScope, bytes);
        self.sent.push_back((request, room));
    }

    /// Reported by the first rank, or else the lowest remaining.
    fn look_for_lost(&self) -> Result<(), Lost> {
        let ended: Vec<bool> = self.peers.iter().map(Peer::has_ended).collect();
        // The first rank exits after its report.
        let others = ended.iter().skip(1).position(|ended| *ended).map(|k| k + 1);
        let Some(rank) = others.or(ended[0].then_some(0)) else { return Ok(()) };
        let Peer { machine, process, .. } = &self.peers[rank];
        let lost = Lost { rank, problem: format!("process {process} on {machine} ended") };
        let speaker = if rank == 0 { ended.iter().position(|ended| !ended) } else { Some(0) };
        if !self.lost.swap(true, Ordering::Relaxed) && speaker == Some(self.rank) {
            let folder = &self.out;
            message::error(&format!(
                "{lost}; last checkpoint, if any: {folder}; resume with --resume --out {folder}"
            ));
        }
        Err(lost)
    }

    fn piece(&mut self, from: usize, message: &mut Vec<u8>) -> Result<usize, Lost> {
        let (mut looks, mut since, mut watched) = (0_u32, None, Instant::now());
        loop {
            let process = self.world.process_at_rank(from as i32);
            if let Some((found, status)) = process.immediate_matched_probe() {
                let length = status.count(u8::equivalent_datatype()) as usize;
                let start = message.len();
                message.resize(start + length, 0);
                found.matched_receive_into(&mut message[start..]);
                return Ok(length);
            }
            looks += 1;
            if looks < self.looks && since.is_none() {
                std::hint::spin_loop();
                continue;
            }
            let now = Instant::now();
            match *since.get_or_insert(now) {
                begun if now - begun < AWAKE => std::thread::yield_now(),
                _ => std::thread::sleep(NAP),
            }
            if now - watched > WATCH {
                watched = now;
                self.settle();
                self.look_for_lost()?;
            }
        }
    }
}

impl Link for Mpi {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.peers.len()
    }

    fn send(&mut self, to: usize, message: &[u8]) -> Result<(), Lost> {
        self.settle();
        // A partial piece is the last.
        let mut rest = message;
        loop {
            let (piece, left) = rest.split_at(rest.len().min(PIECE));
            self.post(to, piece);
            if piece.len() < PIECE {
                return Ok(());
            }
            rest = left;
        }
    }

    fn receive(&mut self, from: usize, message: &mut Vec<u8>) -> Result<(), Lost> {
        message.clear();
        while self.piece(from, message)? == PIECE {}
        Ok(())
    }
}

impl Drop for Mpi {
    fn drop(&mut self) {
        let begun = Instant::now();
        while !self.sent.is_empty()
            && !self.lost.load(Ordering::Relaxed)
            && begun.elapsed() < Duration::from_secs(5)
        {
            self.settle();
            std::thread::yield_now();
            if self.look_for_lost().is_err() {
                break;
            }
        }
        // Buffers in transit must outlive the process.
        self.sent.drain(..).for_each(std::mem::forget);
    }
}
