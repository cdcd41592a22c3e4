//! The server: routes, bounds and panics.
//!
//! A request has at most [`MOST_BYTES`], and a model [`models::MOST_BYTES`]. What is answered in this process runs on a thread of its own, and is an error
//! after [`MOST_TIME`]; if it panics, this request alone fails.

use std::net::{SocketAddr, TcpListener};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use axum::body::Bytes;
use axum::extract::{DefaultBodyLimit, FromRef, Query, State};
use axum::http::{StatusCode, Uri, header};
use axum::middleware::{from_fn_with_state, map_response};
use axum::response::{IntoResponse as _, Response};
use axum::routing::{get, post};
use axum::{Json, Router};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use tokio::sync::Semaphore;
use tokio::time::timeout;

use super::analyse::Analyse;
use super::commands::{Check, Picture};
use super::description::Folder;
use super::editor::Place;
use super::generate::{Download, Generate};
use super::geometry::GeometryRequest;
use super::models::{self, SharedModels};
use super::problem::Problem;
use super::{assets, guard, start};

/// The bytes of a request that is not a model.
const MOST_BYTES: usize = 1 << 20;

/// The time of an answer in this process.
const MOST_TIME: Duration = Duration::from_secs(20);

/// The answers that this process computes at the same time, which bounds its memory. Others wait.
static HERE: Semaphore = Semaphore::const_new(8);

/// Answers until the process ends.
pub(super) fn run(listener: TcpListener, address: SocketAddr, folder: Option<PathBuf>) -> std::io::Result<()> {
    listener.set_nonblocking(true)?;
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build()?;
    runtime.block_on(async move {
        let listener = tokio::net::TcpListener::from_std(listener)?;
        let app = App { folder: Arc::new(Folder(folder)), models: SharedModels::default() };
        axum::serve(listener, router(address, app)).await
    })
}

fn router(address: SocketAddr, app: App) -> Router {
    Router::new()
        .route("/api/start", get(start))
        .route("/api/model", post(model).layer(DefaultBodyLimit::max(models::MOST_BYTES)))
        .route("/api/analyse", post(analyse))
        .route("/api/hover", post(hover))
        .route("/api/complete", post(complete))
        .route("/api/generate", post(generate))
        .route("/api/download", post(download))
        .route("/api/geometry", post(geometry))
        .route("/api/render", post(render))
        .route("/api/predict", post(predict))
        .route("/api/check", post(check))
        .fallback(get(asset))
        .layer(DefaultBodyLimit::max(MOST_BYTES))
        .layer(map_response(explained))
        .layer(from_fn_with_state(address, guard::check))
        .with_state(app)
}

/// What the requests share.
#[derive(Clone)]
struct App {
    folder: Arc<Folder>,
    models: SharedModels,
}

impl FromRef<App> for Arc<Folder> {
    fn from_ref(app: &App) -> Self {
        Arc::clone(&app.folder)
    }
}

impl FromRef<App> for SharedModels {
    fn from_ref(app: &App) -> Self {
        Arc::clone(&app.models)
    }
}

type UserFiles = State<Arc<Folder>>;

async fn start(State(models): State<SharedModels>) -> Result<Json<Value>, Problem> {
    start::answer(&models).await.map(Json)
}

/// The name of a model's file, in the query.
#[derive(Deserialize)]
struct ModelName {
    name: String,
}

async fn model(
    State(models): State<SharedModels>,
    Query(ModelName { name }): Query<ModelName>,
    body: Bytes,
) -> Result<Json<Value>, Problem> {
    here(move || models.add(&name, body).map(Json)).await
}

async fn analyse(State(folder): UserFiles, body: Bytes) -> Result<Json<Value>, Problem> {
    let request: Analyse = parsed(&body)?;
    here(move || request.answer(&folder).map(Json)).await
}

async fn hover(State(folder): UserFiles, body: Bytes) -> Result<Json<Value>, Problem> {
    let request: Place = parsed(&body)?;
    here(move || request.hover(&folder).map(Json)).await
}

async fn complete(State(folder): UserFiles, body: Bytes) -> Result<Json<Value>, Problem> {
    let request: Place = parsed(&body)?;
    here(move || request.complete(&folder).map(Json)).await
}

async fn generate(State(folder): UserFiles, body: Bytes) -> Result<Json<Value>, Problem> {
    let request: Generate = parsed(&body)?;
    here(move || request.answer(&folder).map(Json)).await
}

async fn download(State(folder): UserFiles, body: Bytes) -> Result<Response, Problem> {
    let request: Download = parsed(&body)?;
    let bytes = here(move || request.answer(&folder)).await?;
    let headers = [(header::CONTENT_TYPE, "application/zip")];
    Ok((headers, bytes).into_response())
}

async fn geometry(State(App { folder, models }): State<App>, body: Bytes) -> Result<Response, Problem> {
    let request: GeometryRequest = parsed(&body)?;
    let bytes = here(move || request.answer(&folder, &models)).await?;
    Ok(([(header::CONTENT_TYPE, "application/octet-stream")], bytes).into_response())
}

async fn render(State(App { folder, models }): State<App>, body: Bytes) -> Result<Json<Value>, Problem> {
    parsed::<Picture>(&body)?.render(&folder, &models).await.map(Json)
}

async fn predict(State(App { folder, models }): State<App>, body: Bytes) -> Result<Json<Value>, Problem> {
    parsed::<Picture>(&body)?.predict(&folder, &models).await.map(Json)
}

async fn check(State(folder): UserFiles, body: Bytes) -> Result<Json<Value>, Problem> {
    parsed::<Check>(&body)?.answer(&folder).await.map(Json)
}

/// Answers a file of the page.
async fn asset(uri: Uri) -> Response {
    match assets::find(uri.path()) {
        Some(asset) => ([(header::CONTENT_TYPE, asset.kind)], asset.bytes).into_response(),
        None => {
            let message = format!("this server has no `{}`", uri.path());
            Problem { status: StatusCode::NOT_FOUND, message }.into_response()
        }
    }
}

/// Gives the answer to a request that is too long a message that says what to do.
async fn explained(response: Response) -> Response {
    match response.status() {
        StatusCode::PAYLOAD_TOO_LARGE => {
            let message = format!(
                "a request has at most {MOST_BYTES} bytes, and a model {}: shorten the description, or use a smaller model",
                models::MOST_BYTES
            );
            Problem { status: StatusCode::PAYLOAD_TOO_LARGE, message }.into_response()
        }
        _ => response,
    }
}

fn parsed<T: DeserializeOwned>(body: &[u8]) -> Result<T, Problem> {
    serde_json::from_slice(body).map_err(|error| Problem::request(format!("the request: {error}")))
}

/// Runs `answer` on a thread that may block, when it is its turn.
async fn here<T: Send + 'static>(answer: impl FnOnce() -> Result<T, Problem> + Send + 'static) -> Result<T, Problem> {
    // The thread of an answer that is too late goes on, and holds its turn until it ends.
    let work = async {
        let turn = HERE.acquire().await;
        let answer = move || {
            let _turn = turn;
            answer()
        };
        tokio::task::spawn_blocking(answer).await
    };
    match timeout(MOST_TIME, work).await {
        Ok(Ok(result)) => result,
        Ok(Err(_)) => Err(Problem::server("a defect of fragbuf ended this request: report it with the description")),
        Err(_) => Err(Problem::input(format!("this took longer than {} seconds: ask for less", MOST_TIME.as_secs()))),
    }
}
