//! Ranks that `mpirun` has started, by rsmpi.
//!
//! A rank that waits looks whether the processes of the others on its machine are still there: MPI itself only waits. `mpirun` ends all
//! ranks soon after it has found one dead, OpenMPI 4.1 within some 0.1 s: the sentence that says which comes at once.

use super::origin::quoted;
use crate::failure::Failure;
use crate::message;
use ::mpi::environment::Universe;
use ::mpi::request::{Request, StaticScope};
use ::mpi::topology::SimpleCommunicator;
use ::mpi::traits::*;
use ::mpi::{Threading, initialize_with_threading};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use std::collections::VecDeque;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use trackbed_dem::ranks::{Link, Lost};

/// Longest piece of a message [bytes]: MPI counts with 31 bits.
const PIECE: usize = 1 << 30;

/// Looks for a message before a rank lets others have its processor, where each has its own, and how long it does so before it sleeps
/// between looks.
const LOOKS: u32 = 2000;
const AWAKE: Duration = Duration::from_millis(20);
const NAP: Duration = Duration::from_micros(100);

/// Time between two looks at the processes of others.
const WATCH: Duration = Duration::from_millis(20);

/// Longest time that a rank waits for one before it to say which is lost.
const PARTING: Duration = Duration::from_secs(2);

/// Bytes of the name of a machine that ranks compare.
const NAME: usize = 64;

/// All ranks.
pub struct World {
    universe: Option<Universe>,
    peers: Arc<Vec<Peer>>,
    /// Whether a rank is lost.
    lost: Arc<AtomicBool>,
}

/// The process of a rank.
#[derive(Clone, Debug)]
struct Peer {
    machine: String,
    process: u32,
    /// Whether it is on this machine.
    here: bool,
}

impl Peer {
    /// Whether it has ended, as far as can be seen from here.
    fn has_ended(&self) -> bool {
        // One that has ended and is not waited for yet has the state Z.
        let state = |text: String| text.rsplit(')').next().and_then(|rest| rest.trim_start().chars().next());
        self.here
            && std::fs::read_to_string(format!("/proc/{}/stat", self.process))
                .map_or(true, |text| matches!(state(text), Some('Z' | 'X')))
    }
}

/// The ranks that `mpirun` has started; none where it has not.
///
/// # Errors
/// MPI does not work.
pub fn join() -> Result<Option<World>, Failure> {
    // What OpenMPI, and MPICH and its relatives, set. Without them MPI would be started for one process.
    let started =
        ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"].iter().any(|v| std::env::var_os(v).is_some());
    if !started {
        return Ok(None);
    }
    // OpenMPI ends a process whose message comes from the memory of one that was killed, before it can say so.
    const COPY: &str = "OMPI_MCA_btl_vader_single_copy_mechanism";
    if std::env::var_os(COPY).is_none() {
        // SAFETY: the command has just begun, and no other thread of it reads or writes the environment.
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

/// The processes of all ranks, by rank.
fn peers(world: &SimpleCommunicator) -> Vec<Peer> {
    let machine = std::fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    let mut own = [0_u8; NAME + 4];
    let name = machine.trim().bytes().take(NAME);
    own.iter_mut().zip(name).for_each(|(to, from)| *to = from);
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
    /// Has the first rank `lead` and all others `follow`; `out` is the folder of the results.
    ///
    /// # Errors
    /// What the first rank says; the others say nothing. Where a rank is lost, all processes end here.
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
            // The first rank says when to end; where it is gone the others see that.
            for signal in [SIGTERM, SIGINT, SIGHUP] {
                _ = signal_hook::flag::register(signal, Arc::default());
            }
            follow(link).map_err(|lost| Failure::Other(lost.to_string()))
        };
        // It is said already which rank is lost; the end of MPI would wait for it.
        let lost = self.lost.load(Ordering::Relaxed);
        if outcome.is_err() && (rank > 0 || lost) {
            // Ranks before this one, of which one says what is lost, must not take this one for it.
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

    /// Whether ranks share processors of this machine.
    fn crowded(&self) -> bool {
        // SAFETY: the call reads a number of the system's.
        let processors = unsafe { libc::sysconf(libc::_SC_NPROCESSORS_ONLN) };
        self.peers.iter().filter(|peer| peer.here).count() > usize::try_from(processors).unwrap_or(1)
    }
}

/// A message on its way.
type Sent = Request<'static, [u8], StaticScope>;

/// Messages by MPI.
struct Mpi {
    world: SimpleCommunicator,
    rank: usize,
    peers: Arc<Vec<Peer>>,
    lost: Arc<AtomicBool>,
    /// Folder of the results.
    out: String,
    /// Looks for a message before others are let in.
    looks: u32,
    /// Messages on their way, and room for the next ones.
    sent: VecDeque<(Sent, Vec<u8>)>,
    spare: Vec<Vec<u8>>,
}

// SAFETY: a communicator and a request are numbers or addresses that MPI gave out; MPI was started for calls by any one thread at
// a time, and a link has one owner.
unsafe impl Send for Mpi {}

impl Mpi {
    /// Takes back the room of messages that are gone.
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
        // SAFETY: the room lies beside the request in `sent`, untouched, until MPI says that the message is gone, or for ever.
        let bytes: &'static [u8] = unsafe { std::slice::from_raw_parts(room.as_ptr(), room.len()) };
        let request = self.world.process_at_rank(to as i32).immediate_send(StaticScope, bytes);
        self.sent.push_back((request, room));
    }

    /// A rank whose process has ended. The first rank says so, or if that has ended the first that is left.
    fn look_for_lost(&self) -> Result<(), Lost> {
        let ended: Vec<bool> = self.peers.iter().map(Peer::has_ended).collect();
        // The first rank ends once it has said that another is lost.
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

    /// Waits for the next piece of a message and appends it; its length.
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
        // A piece that is not full is the last one.
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
        // What is still on its way keeps its room; the process ends.
        self.sent.drain(..).for_each(std::mem::forget);
    }
}
