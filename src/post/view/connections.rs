//! Client connections of the viewer with bounded memory and time: a stalled client is disconnected and delays
//! no others.

use std::collections::HashMap;
use std::future::{Future, poll_fn};
use std::io::{self, IoSlice};
use std::net::TcpListener;
use std::pin::{Pin, pin};
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll};
use std::time::{Duration, Instant};

use http_body_util::Full;
use hyper::body::{Bytes, Incoming};
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper::{Request, Response};
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::TcpStream;
use tokio::sync::Semaphore;
use tokio::task::AbortHandle;

use trackbed_io::guard;

/// Requests computed in parallel.
const THREADS: usize = 4;
/// Most open connections; the longest stalled are closed.
const CONNECTIONS: usize = 128;
/// Open files kept for the responses.
const SPARE: usize = 8;
/// Most unsent bytes; beyond, the longest stalled are closed.
const QUEUED: usize = 512 << 20;
const HEAD: usize = 16 << 10;
const FIELDS: usize = 64;
/// Time limit for a request header and for progress of a response.
const PATIENCE: Duration = Duration::from_secs(10);

/// Status, content type and content.
pub struct Reply {
    pub status: u16,
    pub kind: &'static str,
    pub content: Bytes,
}

pub trait Respond: Send + Sync + 'static {
    fn respond(&self, head: &hyper::http::request::Parts) -> Reply;

    fn fields(&self) -> &'static [(&'static str, &'static str)];
}

struct Connection {
    /// Last transfer, in milliseconds since the server's start.
    progress: AtomicU64,
    computing: AtomicBool,
    running: AtomicBool,
    /// Unsent bytes.
    queued: AtomicUsize,
}

struct Connections {
    start: Instant,
    /// Semaphore: disconnected clients release their place in the queue.
    threads: Semaphore,
    open: Mutex<HashMap<u64, (Arc<Connection>, AbortHandle)>>,
}

impl Connections {
    fn now(&self) -> u64 {
        self.start.elapsed().as_millis() as u64
    }

    fn open(&self) -> MutexGuard<'_, HashMap<u64, (Arc<Connection>, AbortHandle)>> {
        self.open.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Closes the longest stalled connections beyond `most` or the response limit.
    fn close_stalled(&self, most: usize) {
        let mut open = self.open();
        loop {
            let queued: usize = open.values().map(|(c, _)| c.queued.load(Ordering::Relaxed)).sum();
            if open.len() <= most && (queued <= QUEUED || open.len() <= 1) {
                return;
            }
            // Of queued clients, the oldest have often left.
            let age =
                |c: &Connection| (c.running.load(Ordering::Relaxed), c.progress.load(Ordering::Relaxed));
            let longest = open.iter().min_by_key(|(_, (c, _))| age(c)).map(|(id, _)| *id);
            if let Some((_, task)) = longest.and_then(|id| open.remove(&id)) {
                task.abort();
            }
        }
    }
}

/// Serves the clients of a listener until the process ends.
///
/// # Errors
/// I/O errors.
pub fn serve(listener: TcpListener, site: Arc<impl Respond>) -> io::Result<()> {
    listener.set_nonblocking(true)?;
    let runtime =
        tokio::runtime::Builder::new_current_thread().enable_all().max_blocking_threads(THREADS).build()?;
    runtime.block_on(async {
        let listener = tokio::net::TcpListener::from_std(listener)?;
        let connections = Arc::new(Connections {
            start: Instant::now(),
            threads: Semaphore::new(THREADS),
            open: Mutex::default(),
        });
        let most = guard::free_files(CONNECTIONS + SPARE).saturating_sub(SPARE).max(2);
        for id in 0_u64.. {
            match listener.accept().await {
                Ok((stream, _)) => {
                    connections.close_stalled(most - 1);
                    open(id, stream, &connections, &site);
                }
                // Out of file handles.
                Err(_) => {
                    let open = connections.open().len();
                    connections.close_stalled(open / 2);
                    tokio::time::sleep(Duration::from_millis(50)).await;
                }
            }
        }
        Ok(())
    })
}

fn open(id: u64, stream: TcpStream, connections: &Arc<Connections>, site: &Arc<impl Respond>) {
    let connection = Arc::new(Connection {
        progress: AtomicU64::new(connections.now()),
        computing: AtomicBool::new(false),
        running: AtomicBool::new(false),
        queued: AtomicUsize::new(0),
    });
    let (all, site, own) = (connections.clone(), site.clone(), connection.clone());
    let task = tokio::spawn(async move {
        let io = Watched { stream, connection: own.clone(), connections: all.clone() };
        let service = service_fn(|request| response(request, site.clone(), &own, &all));
        let served = http1::Builder::new()
            .timer(TokioTimer::new())
            .header_read_timeout(PATIENCE)
            .max_buf_size(HEAD)
            .max_headers(FIELDS)
            .half_close(true)
            .title_case_headers(true)
            .serve_connection(TokioIo::new(io), service);
        let (mut served, mut stalled) = (pin!(served), pin!(stalled(&own, &all)));
        // Disconnected clients get no response.
        poll_fn(|context| match served.as_mut().poll(context) {
            Poll::Ready(_) => Poll::Ready(()),
            Poll::Pending => stalled.as_mut().poll(context),
        })
        .await;
        all.open().remove(&id);
    });
    connections.open().insert(id, (connection, task.abort_handle()));
}

/// Ends once a connection stalls, except while its response is computed.
async fn stalled(connection: &Connection, connections: &Connections) {
    let patience = PATIENCE.as_millis() as u64;
    loop {
        let idle = connections.now().saturating_sub(connection.progress.load(Ordering::Relaxed));
        let computing = connection.computing.load(Ordering::Relaxed);
        if idle >= patience && !computing {
            return;
        }
        let wait = if computing { patience } else { patience - idle };
        tokio::time::sleep(Duration::from_millis(wait.max(1))).await;
    }
}

async fn response(
    request: Request<Incoming>,
    site: Arc<impl Respond>,
    connection: &Connection,
    connections: &Connections,
) -> hyper::http::Result<Response<Full<Bytes>>> {
    let (head, body) = request.into_parts();
    let empty = hyper::body::Body::is_end_stream(&body);
    drop(body);
    let fields = site.fields();
    connection.computing.store(true, Ordering::Relaxed);
    let thread = connections.threads.acquire().await;
    connection.running.store(true, Ordering::Relaxed);
    let computed = tokio::task::spawn_blocking(move || site.respond(&head)).await;
    drop(thread);
    connection.running.store(false, Ordering::Relaxed);
    connection.progress.store(connections.now(), Ordering::Relaxed);
    connection.computing.store(false, Ordering::Relaxed);
    let failed = |_| Reply {
        status: 500,
        kind: "text/plain; charset=utf-8",
        content: Bytes::from_static(b"the request failed in the program"),
    };
    let Reply { status, kind, content } = computed.unwrap_or_else(failed);
    connection.queued.store(content.len(), Ordering::Relaxed);
    connections.close_stalled(CONNECTIONS);
    let mut response = Response::builder().status(status).header("Content-Type", kind);
    for (name, value) in fields {
        response = response.header(*name, *value);
    }
    if !empty {
        // The request body is never read.
        response = response.header("Connection", "close");
    }
    response.body(Full::new(content))
}

struct Watched {
    stream: TcpStream,
    connection: Arc<Connection>,
    connections: Arc<Connections>,
}

impl Watched {
    fn count(&self, written: usize) {
        self.connection.progress.store(self.connections.now(), Ordering::Relaxed);
        let queued = self.connection.queued.load(Ordering::Relaxed);
        self.connection.queued.store(queued.saturating_sub(written), Ordering::Relaxed);
    }

    fn write(
        self: Pin<&mut Self>,
        write: impl FnOnce(Pin<&mut TcpStream>) -> Poll<io::Result<usize>>,
    ) -> Poll<io::Result<usize>> {
        let this = self.get_mut();
        let written = write(Pin::new(&mut this.stream));
        if let Poll::Ready(Ok(count @ 1..)) = written {
            this.count(count);
        }
        written
    }
}

impl AsyncRead for Watched {
    fn poll_read(
        self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let this = self.get_mut();
        let before = buffer.filled().len();
        let read = Pin::new(&mut this.stream).poll_read(context, buffer);
        if buffer.filled().len() > before {
            this.count(0);
        }
        read
    }
}

impl AsyncWrite for Watched {
    fn poll_write(self: Pin<&mut Self>, context: &mut Context<'_>, bytes: &[u8]) -> Poll<io::Result<usize>> {
        self.write(|stream| stream.poll_write(context, bytes))
    }

    fn poll_write_vectored(
        self: Pin<&mut Self>,
        context: &mut Context<'_>,
        pieces: &[IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        self.write(|stream| stream.poll_write_vectored(context, pieces))
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.get_mut().stream).poll_flush(context)
    }

    fn poll_shutdown(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.get_mut().stream).poll_shutdown(context)
    }
}
