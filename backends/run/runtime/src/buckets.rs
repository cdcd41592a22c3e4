//! Every k from one description. A plan's capacity is baked into its code, because local arrays need literals; up to it
//! another k is a uniform. Beyond it other code is needed, which is made once per bucket (1, 2, 4, 8, …) and kept.

use crate::{Error, Pipelines, Renderer, Settings, Shaders};

/// A renderer whose k may be anything that the description can keep.
pub struct Buckets<F> {
    shaders: F,
    settings: Settings,
    made: Vec<Pipelines>,
    renderer: Renderer,
}

impl<F: FnMut(u32) -> Result<Shaders, Error>> Buckets<F> {
    /// `shaders` generates the description for a k; it is called once per bucket.
    pub async fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        settings: &Settings,
        k: u32,
        mut shaders: F,
    ) -> Result<Self, Error> {
        let pipelines = Pipelines::new(device, &shaders(bucket(k))?, settings).await?;
        let mut renderer = Renderer::with(device, queue, &pipelines, settings).await?;
        renderer.switch(&pipelines, k).await?;
        Ok(Buckets { shaders, settings: settings.clone(), made: vec![pipelines], renderer })
    }

    /// The renderer, to draw with. [`Renderer::set_k`] on it stays within the bucket.
    pub fn renderer(&mut self) -> &mut Renderer {
        &mut self.renderer
    }

    /// Keeps `k` fragments per pixel from the next frame on: a uniform within a bucket, other pipelines across. On an error
    /// everything stays as it was.
    pub async fn set_k(&mut self, k: u32) -> Result<(), Error> {
        if k == 0 {
            return Err(Error::BadValue { name: "k".to_owned(), wanted: "at least 1".to_owned() });
        }
        let wanted = bucket(k);
        if self.renderer.capacity() == wanted {
            return self.renderer.set_k(k).await;
        }
        let known = self.made.iter().find(|pipelines| pipelines.capacity() == wanted).cloned();
        let pipelines = match known {
            Some(pipelines) => pipelines,
            None => {
                let made = Pipelines::new(self.renderer.device(), &(self.shaders)(wanted)?, &self.settings).await?;
                if made.capacity() < k {
                    return Err(Error::BadValue {
                        name: "k".to_owned(),
                        wanted: format!("at most the capacity of the shaders made for it, {}", made.capacity()),
                    });
                }
                self.made.push(made.clone());
                made
            }
        };
        self.renderer.switch(&pipelines, k).await
    }
}

/// The capacity that serves `k`. No number of fragments: left to the shaders to refuse.
fn bucket(k: u32) -> u32 {
    k.checked_next_power_of_two().unwrap_or(k)
}
