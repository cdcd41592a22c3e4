//! The workgroups of a compute pass.

use crate::manifest::Pass;
use crate::{Call, Error};

impl Call<'_> {
    /// Returns the workgroups of a pass along x, y and z. `most`: the greatest numbers that the device allows.
    pub fn groups(&self, pass: &Pass, most: [u32; 3]) -> Result<[u32; 3], Error> {
        let mut groups = [1; 3];
        for ((count, formula), most) in groups.iter_mut().zip(&pass.groups).zip(most) {
            let value = self.value(formula)?;
            *count = u32::try_from(value).ok().filter(|value| *value <= most).ok_or_else(|| {
                Error(format!(
                    "the pass `{}` has {value} workgroups, and the device allows {most}: draw a smaller frame or \
                     slices of it",
                    pass.name
                ))
            })?;
        }
        Ok(groups)
    }
}
