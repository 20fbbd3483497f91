//! Connections of clients to the viewer, each with bounded memory and time: a client that sends or reads nothing, or too much, loses its
//! connection and does not delay others.

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

/// Requests that are computed at a time.
const THREADS: usize = 4;
/// Open connections; of more, those without progress for the longest time are closed.
const CONNECTIONS: usize = 128;
/// Responses that are computed but not sent, of all connections [bytes]; of more, the same connections are closed.
const QUEUED: usize = 512 << 20;
/// Longest head of a request [bytes].
const HEAD: usize = 16 << 10;
/// Most header fields of a request.
const FIELDS: usize = 64;
/// Time in which the head of a request must arrive, and in which a client must read some of its response.
const PATIENCE: Duration = Duration::from_secs(10);

/// A response: status, type of its content, and the content.
pub struct Reply {
    pub status: u16,
    pub kind: &'static str,
    pub content: Bytes,
}

/// Makes the responses to requests.
pub trait Respond: Send + Sync + 'static {
    /// The response to a request whose body is not read.
    fn respond(&self, head: &hyper::http::request::Parts) -> Reply;

    /// Header fields of all responses.
    fn fields(&self) -> &'static [(&'static str, &'static str)];
}

/// State of a connection.
struct Connection {
    /// Milliseconds since the server's start at which bytes went either way.
    progress: AtomicU64,
    /// Whether its response is being computed, or waits for a thread.
    computing: AtomicBool,
    /// Whether a thread computes its response.
    running: AtomicBool,
    /// Bytes of its response that are not sent.
    queued: AtomicUsize,
}

/// All open connections.
struct Connections {
    start: Instant,
    /// Threads for requests: who loses the connection no longer waits for one.
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

    /// Closes connections without progress for the longest time until at most `most` are left and their responses have room.
    fn close_stalled(&self, most: usize) {
        let mut open = self.open();
        loop {
            let queued: usize = open.values().map(|(c, _)| c.queued.load(Ordering::Relaxed)).sum();
            if open.len() <= most && (queued <= QUEUED || open.len() <= 1) {
                return;
            }
            // Of clients that wait for a thread, the oldest have often gone.
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
/// The system has no resources for the server.
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
        for id in 0_u64.. {
            match listener.accept().await {
                Ok((stream, _)) => {
                    connections.close_stalled(CONNECTIONS - 1);
                    open(id, stream, &connections, &site);
                }
                // The system has no file handles left.
                Err(_) => {
                    connections.close_stalled(CONNECTIONS / 4);
                    tokio::time::sleep(Duration::from_millis(50)).await;
                }
            }
        }
        Ok(())
    })
}

/// Starts the task of a connection.
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
        // A client that has gone gets no response.
        poll_fn(|context| match served.as_mut().poll(context) {
            Poll::Ready(_) => Poll::Ready(()),
            Poll::Pending => stalled.as_mut().poll(context),
        })
        .await;
        all.open().remove(&id);
    });
    connections.open().insert(id, (connection, task.abort_handle()));
}

/// Ends once a connection has made no progress for too long, other than by the computation of its response.
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

/// The response to a request, computed on a thread of its own.
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
        // The body that follows is never read.
        response = response.header("Connection", "close");
    }
    response.body(Full::new(content))
}

/// A stream that stores when bytes went either way.
struct Watched {
    stream: TcpStream,
    connection: Arc<Connection>,
    connections: Arc<Connections>,
}

impl Watched {
    /// Stores that bytes have gone, `written` of them to the client.
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
