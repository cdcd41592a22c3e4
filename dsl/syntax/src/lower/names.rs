//! Names inside a WGSL function: the user's, unless one would be taken twice.
//!
//! In: the name the user wrote. Out: a name that nothing visible has. Rust lets a name be declared again beside the first
//! (`let x = x + 1.0;`), WGSL does not.

use fragbuf_model::mangled;

/// The names that are visible where printing is.
pub(super) struct Names {
    scopes: Vec<Vec<String>>,
}

impl Default for Names {
    fn default() -> Self {
        Names { scopes: vec![Vec::new()] }
    }
}

impl Names {
    pub(super) fn open(&mut self) {
        self.scopes.push(Vec::new());
    }

    pub(super) fn close(&mut self) {
        self.scopes.pop();
    }

    /// `wanted`, or the first of `wanted_1`, `wanted_2`, … that is free.
    pub(super) fn fresh(&mut self, wanted: &str) -> String {
        let mut name = mangled(wanted).into_owned();
        let mut count = 0_u32;
        while self.is_visible(&name) {
            count += 1;
            name = mangled(&format!("{wanted}_{count}")).into_owned();
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
