//! Stepwise simulation.

use crate::link::{Goal, Link, Order, Place, Push, Report};
use crate::run::{Reports, folder, options, wait};
use numpy::{
    AllowTypeChange, Element, PyArray1, PyArray2, PyArrayLike2, PyArrayMethods, PyReadwriteArray2,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyIndexError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::mpsc::{self, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use trackbed::failure::Failure;
use trackbed::run::{self as running, Accompanied, Interrupt, Shown};
use trackbed_dem as dem;

/// A run that pauses between windows: see `trackbed.Simulation`.
#[pyclass(subclass, module = "trackbed._trackbed")]
pub struct Simulation {
    link: Arc<Link>,
    orders: Option<Sender<Order>>,
    reports: Reports<Report>,
    worker: Option<JoinHandle<()>>,
    interrupt: Interrupt,
    place: Place,
    /// Results directory.
    out: PathBuf,
    /// Set once complete.
    folder: Option<PathBuf>,
}

#[pymethods]
impl Simulation {
    #[new]
    #[pyo3(signature = (scene, text, out, set, threads, memory, resume, from_run, bed, force, strict, progress))]
    #[expect(clippy::too_many_arguments, reason = "one for each option of the program")]
    fn new(
        py: Python<'_>,
        scene: PathBuf,
        text: Option<String>,
        out: Option<PathBuf>,
        set: Vec<String>,
        threads: Option<usize>,
        memory: Option<&str>,
        resume: bool,
        from_run: Option<PathBuf>,
        bed: bool,
        force: bool,
        strict: bool,
        progress: bool,
    ) -> PyResult<Simulation> {
        let mut options =
            options(text, out, set, threads, memory, resume, from_run, bed, force, strict, progress)?;
        let out = running::default_folder(&scene, &options.set);
        let out = options.out.get_or_insert(out).clone();
        let interrupt = options.interrupt.clone();
        let (orders, received) = mpsc::channel();
        let (send, reports) = mpsc::channel();
        let link = Arc::new(Link::new(received, send.clone()));
        options.accompanied = Accompanied(Some(link.clone()));
        let worker = thread::spawn(move || {
            let outcome = trackbed::guard::guarded(|| running::run(&scene, &options));
            // The receiver may be gone.
            let _ = send.send(Report::Ended(outcome));
        });
        let mut simulation = Simulation {
            link,
            orders: Some(orders),
            reports: Mutex::new(reports),
            worker: Some(worker),
            interrupt,
            place: Place::default(),
            out,
            folder: None,
        };
        // While packing, the run saves and stops.
        let (report, signal) = wait(py, &simulation.reports, || simulation.interrupt.request())?;
        simulation.take(report)?;
        signal.map_or(Ok(simulation), Err)
    }

    /// Time since loading began [s].
    #[getter]
    fn time(&self) -> f64 {
        self.place.time
    }

    /// Windows done: steps in which forces and motions of grains and solid are exchanged, and rows may be written.
    #[getter(windows)]
    fn windows_done(&self) -> u64 {
        self.place.done
    }

    /// Windows of the whole run, as far as is known.
    #[getter]
    fn windows_in_all(&self) -> u64 {
        self.place.windows
    }

    /// Whether the last window is done. The results are complete after `finish`.
    #[getter]
    fn finished(&self) -> bool {
        self.folder.is_some() || (self.place.windows > 0 && self.place.done >= self.place.windows)
    }

    /// Results directory, also of a run in progress.
    #[getter]
    fn out(&self) -> PathBuf {
        self.out.clone()
    }

    /// Folder of the results, once they are complete.
    #[getter]
    fn folder(&self) -> Option<PathBuf> {
        self.folder.clone()
    }

    /// Advances by so many windows, or to the last one if that comes first. Ctrl-C pauses after the present window.
    #[pyo3(signature = (windows = 1))]
    fn step(&mut self, py: Python<'_>, windows: u64) -> PyResult<()> {
        if windows == 0 {
            return Err(PyValueError::new_err("windows: found 0, expected 1 or more"));
        }
        self.go(py, Goal::Windows(windows))
    }

    /// Advances to the end of the first window at or after `time` [s], or to the last one if that comes first.
    fn run_until(&mut self, py: Python<'_>, time: f64) -> PyResult<()> {
        if !time.is_finite() {
            return Err(PyValueError::new_err(format!("time: found {time}, expected seconds")));
        }
        if time > self.place.time { self.go(py, Goal::Time(time)) } else { Ok(()) }
    }

    /// Completes the run, writes its results and returns their folder; the state is then no longer in memory.
    fn finish(&mut self, py: Python<'_>) -> PyResult<PathBuf> {
        loop {
            if let Some(folder) = &self.folder {
                return Ok(folder.clone());
            }
            self.send(py, Goal::End)?;
        }
    }

    /// Stops a run that is not done; a checkpoint is kept, from which it can be resumed.
    fn close(&mut self, py: Python<'_>) {
        self.stop(py);
    }

    /// Stops the run with a checkpoint, of the first window at the earliest, and writes its results so far: their folder, and the
    /// message of the stop; no message if the run was complete.
    fn halt(&mut self, py: Python<'_>) -> PyResult<(PathBuf, Option<String>)> {
        if self.finished() {
            return Ok((self.finish(py)?, None));
        }
        self.orders.as_ref().ok_or_else(closed)?;
        self.stop(py);
        let reports = self.reports.get_mut().unwrap_or_else(PoisonError::into_inner);
        let ended = reports.try_iter().find_map(|report| match report {
            Report::Ended(outcome) => Some(outcome),
            Report::Paused(_) => None,
        });
        match ended.ok_or_else(closed)? {
            Err(Failure::Interrupted(text)) => Ok((self.out.clone(), Some(text))),
            outcome => {
                let complete = folder(outcome)?;
                self.folder = Some(complete.clone());
                Ok((complete, None))
            }
        }
    }

    /// Number of bodies: grains and sleepers, those that have not come yet and those that have left included.
    fn __len__(&self) -> PyResult<usize> {
        self.grains(|model, _| model.body_count())
    }

    /// Centres of mass [m], shape (bodies, 3); `out`: an array that is filled and returned.
    #[pyo3(signature = (out = None))]
    fn positions<'py>(
        &self,
        py: Python<'py>,
        out: Option<Bound<'py, PyArray2<f64>>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, out, |_, state, body| state.position(body).into())
    }

    /// Velocities of the centres of mass [m/s], shape (bodies, 3), half a step before the present time.
    #[pyo3(signature = (out = None))]
    fn velocities<'py>(
        &self,
        py: Python<'py>,
        out: Option<Bound<'py, PyArray2<f64>>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, out, |_, state, body| state.velocity(body).into())
    }

    /// Angular velocities [rad/s] in world axes, shape (bodies, 3).
    #[pyo3(signature = (out = None))]
    fn spins<'py>(
        &self,
        py: Python<'py>,
        out: Option<Bound<'py, PyArray2<f64>>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, out, |_, state, body| state.spin(body).into())
    }

    /// Unit quaternions (w, x, y, z) that turn principal axes into world axes, shape (bodies, 4).
    #[pyo3(signature = (out = None))]
    fn orientations<'py>(
        &self,
        py: Python<'py>,
        out: Option<Bound<'py, PyArray2<f64>>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, out, |model, state, body| {
            let q = state.orientation(model, body);
            [q.w, q.i, q.j, q.k]
        })
    }

    /// Radii of the spheres around each body, or of the sphere that it is [m].
    fn radii<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.list(py, |model, _, body| model.radius(body))
    }

    /// Masses [kg].
    fn masses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.list(py, |model, _, body| model.mass(body))
    }

    /// Which bodies are there.
    fn present<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<bool>>> {
        self.list(py, |_, state, body| state.present(body))
    }

    /// Contacts: bodies (contacts, 2), the second -1 where it is a wall, the solid or another thing that is no body; points [m] (contacts, 3);
    /// forces on the first body [N] (contacts, 3); overlaps [m].
    #[expect(clippy::type_complexity, reason = "four arrays")]
    fn contacts<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(
        Bound<'py, PyArray2<i64>>,
        Bound<'py, PyArray2<f64>>,
        Bound<'py, PyArray2<f64>>,
        Bound<'py, PyArray1<f64>>,
    )> {
        let all = py.detach(|| self.grains(dem::measure::contacts))?;
        let bodies: Vec<[i64; 2]> = all
            .iter()
            .map(|c| {
                let other = match c.b {
                    dem::Partner::Body(body) => body as i64,
                    _ => -1,
                };
                [c.a as i64, other]
            })
            .collect();
        let points: Vec<[f64; 3]> = all.iter().map(|c| c.point.into()).collect();
        let forces: Vec<[f64; 3]> = all.iter().map(|c| c.force.into()).collect();
        let overlaps: Vec<f64> = all.iter().map(|c| c.overlap).collect();
        Ok((table(py, &bodies)?, table(py, &points)?, table(py, &forces)?, PyArray1::from_vec(py, overlaps)))
    }

    /// Nodes of the solid as its mesh has them [m], shape (nodes, 3).
    #[pyo3(signature = (out = None))]
    fn nodes<'py>(
        &self,
        py: Python<'py>,
        out: Option<Bound<'py, PyArray2<f64>>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.nodal(py, out, |mesh, _| mesh)
    }

    /// Displacements of the nodes of the solid [m], shape (nodes, 3), as frames show them.
    #[pyo3(signature = (out = None))]
    fn displacements<'py>(
        &self,
        py: Python<'py>,
        out: Option<Bound<'py, PyArray2<f64>>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.nodal(py, out, |_, u| u)
    }

    /// Energy stored now and spent so far [J], by name.
    fn energy(&self) -> PyResult<Vec<(&'static str, f64)>> {
        self.look(|shown| {
            let (e, s) = (&shown.stored, &shown.spent);
            Ok(vec![
                ("grains_kinetic", e.grains_kinetic),
                ("contact_springs", e.contact_springs),
                ("bonds", e.bonds),
                ("grains_gravity", e.grains_gravity),
                ("solid_kinetic", e.solid_kinetic),
                ("solid_strain", e.solid_strain),
                ("solid_gravity", e.solid_gravity),
                ("applied_work", s.applied_work),
                ("wall_work", s.wall_work),
                ("solid_load_work", s.solid_load_work),
                ("dashpot", s.dashpot),
                ("friction", s.friction),
            ])
        })
    }

    /// Pushes a body with a force [N] through its centre of mass in every step from now on; a further call replaces it, zero takes it
    /// away. Its work enters the account of energy. It is no part of a checkpoint.
    fn apply_force(&self, body: isize, force: [f64; 3]) -> PyResult<()> {
        if !force.iter().all(|f| f.is_finite()) {
            return Err(PyValueError::new_err(format!(
                "force: found {force:?}, expected three finite numbers"
            )));
        }
        let count = self.grains(|model, _| model.body_count())?;
        let found = usize::try_from(body).ok().filter(|body| *body < count);
        let body = found.ok_or_else(|| {
            PyIndexError::new_err(format!("body: found {body}, expected 0 to {}", count as isize - 1))
        })?;
        let mut pushes = self.link.pushes();
        pushes.retain(|push| push.body != body);
        if force != [0.0; 3] {
            pushes.push(Push { body, force });
        }
        Ok(())
    }

    /// Applies forces [N], shape (bodies, 3), through the centres of mass in every step from now on, in place of all earlier ones.
    fn apply_forces(&self, forces: PyArrayLike2<'_, f64, AllowTypeChange>) -> PyResult<()> {
        let forces = forces.as_array();
        let count = self.grains(|model, _| model.body_count())?;
        if forces.shape() != [count, 3] {
            let found = forces.shape();
            return Err(PyValueError::new_err(format!(
                "forces: found shape {found:?}, expected ({count}, 3)"
            )));
        }
        let rows = forces.rows().into_iter().map(|row| [row[0], row[1], row[2]]).enumerate();
        let all: Vec<Push> =
            rows.filter(|(_, force)| *force != [0.0; 3]).map(|(body, force)| Push { body, force }).collect();
        if let Some(push) = all.iter().find(|push| !push.force.iter().all(|f| f.is_finite())) {
            return Err(PyValueError::new_err(format!(
                "forces: found {:?} on body {}, expected finite numbers",
                push.force, push.body
            )));
        }
        *self.link.pushes() = all;
        Ok(())
    }

    /// Takes all applied forces away.
    fn clear_forces(&self) {
        self.link.pushes().clear();
    }
}

impl Simulation {
    fn go(&mut self, py: Python<'_>, goal: Goal) -> PyResult<()> {
        if self.finished() { Ok(()) } else { self.send(py, goal) }
    }

    fn send(&mut self, py: Python<'_>, goal: Goal) -> PyResult<()> {
        let orders = self.orders.as_ref().ok_or_else(closed)?;
        orders.send(Order::Go(goal)).map_err(|_| closed())?;
        let (report, signal) = wait(py, &self.reports, || self.link.pause())?;
        self.take(report)?;
        signal.map_or(Ok(()), Err)
    }

    fn take(&mut self, report: Report) -> PyResult<()> {
        match report {
            Report::Paused(place) => self.place = place,
            Report::Ended(outcome) => {
                self.orders = None;
                self.place.done = self.place.windows;
                self.folder = Some(folder(outcome)?);
            }
        }
        Ok(())
    }

    fn look<T: Send + 'static>(
        &self,
        look: impl FnOnce(&Shown<'_>) -> PyResult<T> + Send + 'static,
    ) -> PyResult<T> {
        let orders = self.orders.as_ref().ok_or_else(closed)?;
        let (send, seen) = mpsc::channel();
        let task = Box::new(move |shown: &Shown<'_>| {
            // The requester waits.
            let _ = send.send(look(shown));
        });
        orders.send(Order::Look(task)).map_err(|_| closed())?;
        seen.recv().map_err(|_| closed())?
    }

    fn grains<T: Send + 'static>(
        &self,
        look: impl FnOnce(&dem::Model, &dem::State) -> T + Send + 'static,
    ) -> PyResult<T> {
        self.look(|shown| match shown.grains {
            Some(grains) => Ok(look(grains.model, grains.state)),
            None => Err(PyValueError::new_err("the scene has no grains")),
        })
    }

    /// One row per body, filled in place.
    fn rows<'py, const N: usize>(
        &self,
        py: Python<'py>,
        out: Option<Bound<'py, PyArray2<f64>>>,
        row: impl Fn(&dem::Model, &dem::State, usize) -> [f64; N] + Send + 'static,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let count = self.grains(|model, _| model.body_count())?;
        self.fill(py, out, [count, N], move |shown, values| {
            let Some(grains) = shown.grains else { return };
            for (body, place) in values.chunks_exact_mut(N).enumerate() {
                place.copy_from_slice(&row(grains.model, grains.state, body));
            }
        })
    }

    fn nodal<'py>(
        &self,
        py: Python<'py>,
        out: Option<Bound<'py, PyArray2<f64>>>,
        value: impl Fn(f64, f64) -> f64 + Send + 'static,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let count = self.look(|shown| match shown.solid {
            Some(solid) => Ok(solid.model.mesh().node_count()),
            None => Err(PyValueError::new_err("the scene has no solid")),
        })?;
        self.fill(py, out, [count, 3], move |shown, values| {
            let Some(solid) = shown.solid else { return };
            let nodes = &solid.model.mesh().coordinates;
            for (node, place) in values.chunks_exact_mut(3).enumerate() {
                for axis in 0..3 {
                    place[axis] = value(nodes[node][axis], solid.state.u[3 * node + axis]);
                }
            }
        })
    }

    /// Without copying.
    fn fill<'py>(
        &self,
        py: Python<'py>,
        out: Option<Bound<'py, PyArray2<f64>>>,
        [rows, columns]: [usize; 2],
        fill: impl FnOnce(&Shown<'_>, &mut [f64]) + Send + 'static,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let array = match out {
            Some(array) if array.shape() == [rows, columns] => array,
            Some(array) => {
                let found = array.shape();
                return Err(PyValueError::new_err(format!(
                    "out: found shape {found:?}, expected ({rows}, {columns})"
                )));
            }
            None => PyArray2::zeros(py, [rows, columns], false),
        };
        let mut borrowed: PyReadwriteArray2<'_, f64> = array.try_readwrite()?;
        let values = borrowed.as_slice_mut().map_err(|_| {
            PyValueError::new_err(
                "out: found an array that is not contiguous, expected rows one after another",
            )
        })?;
        let lent = Lent(values.as_mut_ptr(), values.len());
        self.look(move |shown| {
            // Fields alone are not `Send`.
            let lent = lent;
            let Lent(start, count) = lent;
            // SAFETY: exclusively borrowed and alive while the caller waits.
            fill(shown, unsafe { std::slice::from_raw_parts_mut(start, count) });
            Ok(())
        })?;
        drop(borrowed);
        Ok(array)
    }

    fn list<'py, T: Element + Copy + Send + 'static>(
        &self,
        py: Python<'py>,
        value: impl Fn(&dem::Model, &dem::State, usize) -> T + Send + 'static,
    ) -> PyResult<Bound<'py, PyArray1<T>>> {
        let all = move |model: &dem::Model, state: &dem::State| -> Vec<T> {
            (0..model.body_count()).map(|body| value(model, state, body)).collect()
        };
        Ok(PyArray1::from_vec(py, self.grains(all)?))
    }

    fn stop(&mut self, py: Python<'_>) {
        self.interrupt.request();
        self.orders = None;
        if let Some(worker) = self.worker.take() {
            // Its report is not needed.
            let _ = py.detach(|| worker.join());
        }
    }
}

impl Drop for Simulation {
    fn drop(&mut self) {
        Python::attach(|py| self.stop(py));
    }
}

/// The owner waits.
struct Lent(*mut f64, usize);

// SAFETY: the owner waits.
unsafe impl Send for Lent {}

fn table<'py, T: Element + Copy, const N: usize>(
    py: Python<'py>,
    rows: &[[T; N]],
) -> PyResult<Bound<'py, PyArray2<T>>> {
    PyArray1::from_slice(py, rows.as_flattened()).reshape([rows.len(), N])
}

fn closed() -> PyErr {
    PyRuntimeError::new_err(
        "the run has ended, and its last state is not in memory: resume a stopped run with resume=True",
    )
}
