//! What a renderer knows about the caller's scene: the boxes of its objects, and its draws.

use std::sync::PoisonError;

use fragbuf_frame::Conditions;

use crate::conditional::{ConditionalDraws, conditional_draws};
use crate::draws::{SceneDraw, check_draws};
use crate::objects::Objects;
use crate::queries::Queries;
use crate::{Error, ObjectBox, Renderer};

impl Renderer {
    /// Sets the boxes of the caller's objects, for passes that draw boxes or visible objects. The index of a box is the object's
    /// number in [`Call::objects`](crate::Call::objects). Without boxes the scene is one object, which is always drawn. Boxes are drawn
    /// with a margin of 1/64 of their greatest extent; those that the near plane clips and those below a pixel are never dropped.
    pub async fn set_objects(&mut self, boxes: &[ObjectBox]) -> Result<(), Error> {
        let count = u32::try_from(boxes.len()).unwrap_or(u32::MAX);
        let queries = Queries::new(&self.device, self.pipeline_set().queries(count)).await?;
        let draws = self.draws.clone().unwrap_or_default();
        let conditional = self.conditional_draws(count, &draws).await?;
        let inputs = &self.pipeline_set().inputs;
        self.objects = match boxes.is_empty() {
            true => None,
            false => Some(Objects::new(&self.device, &self.queue, inputs, boxes).await?),
        };
        self.queries = queries;
        self.conditional = conditional;
        self.frame_id += 1;
        Ok(())
    }

    /// Sets the draws of the caller's scene, which [`Call::draw`](crate::Call::draw) records, with the objects that they belong to.
    /// Frames whose conditions the device evaluates need them ([`Conditions::OnDevice`]).
    pub async fn set_draws(&mut self, draws: &[SceneDraw]) -> Result<(), Error> {
        check_draws(&self.device, draws)?;
        let objects = self.objects.as_ref().map_or(0, |objects| objects.boxes().len() as u32);
        self.conditional = self.conditional_draws(objects, draws).await?;
        self.draws = Some(draws.to_vec());
        self.frame_id += 1;
        Ok(())
    }

    /// Returns the device's conditions for this many objects and these draws.
    pub(crate) async fn conditional_draws(
        &self,
        objects: u32,
        draws: &[SceneDraw],
    ) -> Result<Option<ConditionalDraws>, Error> {
        match self.conditions {
            Conditions::OnHost => Ok(None),
            Conditions::OnDevice => conditional_draws((&self.device, &self.queue), self.plan(), objects, draws).await,
        }
    }

    /// Whether no query of its box can decide whether an object is visible.
    pub(crate) fn is_undecided(&self, object: &ObjectBox) -> bool {
        let values = &self.resources.values;
        let camera = self.camera.lock().unwrap_or_else(PoisonError::into_inner);
        object.is_undecided(&camera, (values.width(), values.height()))
    }
}
