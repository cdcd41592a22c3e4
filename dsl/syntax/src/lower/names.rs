//! Names inside a WGSL function: the user's names, made unique.
//!
//! Input: a name as the user wrote it. Output: a name that no visible declaration has. Rust allows a name to be redeclared in
//! the same scope (`let x = x + 1.0;`), WGSL does not.

use fragbuf_model::mangled;

/// The names that are visible at the current line.
pub(super) struct Names {
    scopes: Vec<Vec<String>>,
}

impl Default for Names {
    fn default() -> Self {
        Names { scopes: vec![Vec::new()] }
    }
}

impl Names {
    /// Opens a scope.
    pub(super) fn open(&mut self) {
        self.scopes.push(Vec::new());
    }

    /// Closes the innermost scope.
    pub(super) fn close(&mut self) {
        self.scopes.pop();
    }

    /// Declares `name`, or the first of `name_1`, `name_2`, … that is free, and returns it.
    pub(super) fn fresh(&mut self, requested: &str) -> String {
        let mut name = mangled(requested).into_owned();
        let mut count = 0_u32;
        while self.is_visible(&name) {
            count += 1;
            name = mangled(&format!("{requested}_{count}")).into_owned();
        }
        if let Some(scope) = self.scopes.last_mut() {
            scope.push(name.clone());
        }
        name
    }

    fn is_visible(&self, name: &str) -> bool {
        self.scopes.iter().flatten().any(|other| other == name)
    }
}
