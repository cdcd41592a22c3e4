//! Decisions of host steps that a later frame uses ([`Decisions::Lagged`](fragbuf_frame::Decisions)), as on devices that work while the
//! host goes on.

use fragbuf_frame::{LaggedValues, Readbacks, Values};

use crate::Error;
use crate::device::Device;

impl Device {
    /// Whether the last frame used what an earlier frame had decided.
    pub fn is_lagged(&self) -> bool {
        self.frame_readbacks() == Readbacks::Lagged
    }

    /// Returns the values of lagged decisions, with those of the last frame, for another device of the same description.
    pub fn lagged_values(&self) -> LaggedValues {
        let mut lag = self.lag.clone();
        lag.advance(&mut self.values.clone());
        lag
    }

    /// Continues with the lagged decisions of another device. Fails if it is of another description, and if there is no memory for the
    /// values.
    pub fn resume_lagged(&mut self, others: &LaggedValues) -> Result<(), Error> {
        let (mut lag, mut values) = (self.lag.clone(), self.values.clone());
        lag.resume(&self.code.plan, others, &mut values)?;
        self.apply_lagged(lag, values)
    }

    /// Applies what the last frame has decided.
    pub(crate) fn decide(&mut self) -> Result<(), Error> {
        let (mut lag, mut values) = (self.lag.clone(), self.values.clone());
        lag.advance(&mut values);
        self.apply_lagged(lag, values)
    }

    /// Returns how the present frame reads words back.
    pub(crate) fn frame_readbacks(&self) -> Readbacks {
        self.lag.readbacks(self.readbacks)
    }

    fn apply_lagged(&mut self, lag: LaggedValues, values: Values) -> Result<(), Error> {
        if values != self.values {
            let rows = self.limits.rows(&self.code.plan, &values, self.settings.slice)?;
            let values = values.with_rows(rows);
            self.memory.resize(&self.code.plan, &values, &self.limits)?;
            self.values = values;
        }
        self.lag = lag;
        Ok(())
    }
}
