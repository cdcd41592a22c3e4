//! The limits of reading and generating a scene, and the memory that one scene has used so far.
//!
//! Every reader takes memory from one [`Budget`] before it allocates: the bytes of each file after decompression, the vertices
//! and triangles of the scene, and its own lists. A number that a file declares is never allocated before it is taken.

use std::cell::{Cell, RefCell};
use std::path::{Path, PathBuf};

use crate::attribute::AttributeRequest;
use crate::error::FileError;
use crate::model::ModelObject;

/// The limits of one scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The bytes that reading a scene may use at one time: its files after decompression, and the scene itself.
    pub memory: u64,
    /// Whether files are read that the model names: material libraries and buffers.
    pub reads_named_files: bool,
}

impl Default for Limits {
    /// Returns limits of 2 GiB, with the files that a model names.
    fn default() -> Self {
        Limits { memory: 2 << 30, reads_named_files: true }
    }
}

/// The bytes of a vertex of a generated scene, and of the sum of its triangles' normals.
const VERTEX: u64 = 12 + 12 + 16 + 12;

/// The bytes of a vertex of a model, without its attributes, while its positions are converted from doubles, which are dropped before
/// the sums of normals.
const MODEL_VERTEX: u64 = 24 + 12 + 12 + 16;

/// The bytes of a triangle of a scene.
pub(crate) const TRIANGLE: u64 = 12;

/// The bytes of an object of a scene without its lists.
pub(crate) const OBJECT: u64 = (size_of::<crate::Object>() + size_of::<ModelObject>()) as u64;

/// The memory that one scene may still use.
#[derive(Debug)]
pub(crate) struct Budget {
    limit: u64,
    left: Cell<u64>,
    /// The bytes of a vertex of a model: [`MODEL_VERTEX`], and its attributes.
    vertex: u64,
    reads_named_files: bool,
    /// The files that were opened.
    files: RefCell<Vec<PathBuf>>,
}

/// Memory that returns to its budget when this value is dropped.
#[must_use = "the memory returns to the budget at once if this is dropped"]
pub(crate) struct Held<'a> {
    budget: &'a Budget,
    bytes: u64,
}

impl Budget {
    pub(crate) fn new(limits: &Limits) -> Self {
        Budget {
            limit: limits.memory,
            left: Cell::new(limits.memory),
            vertex: MODEL_VERTEX,
            reads_named_files: limits.reads_named_files,
            files: RefCell::default(),
        }
    }

    /// Returns a budget for models with these attributes.
    pub(crate) fn with_attributes(limits: &Limits, attributes: &[AttributeRequest]) -> Self {
        let vertex = MODEL_VERTEX + attributes.iter().map(AttributeRequest::bytes).sum::<u64>();
        Budget { vertex, ..Budget::new(limits) }
    }

    /// Records that a file is opened.
    pub(crate) fn open(&self, file: &Path) {
        self.files.borrow_mut().push(file.to_owned());
    }

    /// Returns whether files are read that the model names.
    pub(crate) fn reads_named_files(&self) -> bool {
        self.reads_named_files
    }

    /// Returns the files that were opened.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        self.files.borrow().clone()
    }

    /// Returns the bytes that are left.
    pub(crate) fn left(&self) -> u64 {
        self.left.get()
    }

    /// Takes the memory of `count` items of `bytes` bytes each.
    pub(crate) fn take(&self, count: u64, bytes: u64, what: &str) -> Result<(), FileError> {
        let (needed, left) = (count.saturating_mul(bytes), self.left());
        match left.checked_sub(needed) {
            Some(rest) => {
                self.left.set(rest);
                Ok(())
            }
            None => Err(self.exceeded(needed, what)),
        }
    }

    /// Takes memory like [`Budget::take`] until the result is dropped.
    pub(crate) fn hold(&self, count: u64, bytes: u64, what: &str) -> Result<Held<'_>, FileError> {
        self.take(count, bytes, what)?;
        Ok(Held { budget: self, bytes: count.saturating_mul(bytes) })
    }

    /// Returns memory that was taken.
    pub(crate) fn give_back(&self, bytes: u64) {
        self.left.set(self.left().saturating_add(bytes).min(self.limit));
    }

    /// Takes the memory of `count` more vertices of `object`. It can have 2³² - 1 of them, because indices have 32 bits.
    pub(crate) fn vertices(&self, object: &ModelObject, count: u64) -> Result<(), FileError> {
        let total = (object.positions.len() as u64).saturating_add(count);
        if total > u64::from(u32::MAX) {
            return Err(FileError::whole(format!("an object with {total} vertices: it can have {}", u32::MAX)));
        }
        self.take(count, self.vertex, "the scene's vertices")
    }

    /// Takes the memory of triangles of the scene.
    pub(crate) fn triangles(&self, count: u64) -> Result<(), FileError> {
        self.take(count, TRIANGLE, "the scene's triangles")
    }

    /// Takes the memory of an object that is complete: its lists and its name.
    pub(crate) fn object(&self, object: &crate::Object) -> Result<(), FileError> {
        self.take(1, OBJECT + object.name.len() as u64, "the scene's objects")?;
        self.take(object.positions.len() as u64, VERTEX, "the scene's vertices")?;
        let words = object.attributes.iter().map(|words| words.len() as u64).sum();
        self.take(words, size_of::<u32>() as u64, "the attributes of the scene")?;
        self.triangles(object.triangles.len() as u64)
    }

    /// Returns the error for a part that needs `needed` bytes or more.
    pub(crate) fn exceeded(&self, needed: u64, what: &str) -> FileError {
        FileError::TooLarge { what: what.to_owned(), needed, left: self.left(), limit: self.limit }
    }
}

impl Drop for Held<'_> {
    fn drop(&mut self) {
        self.budget.give_back(self.bytes);
    }
}
