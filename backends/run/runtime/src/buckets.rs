//! Any k from one description. The code contains the plan's capacity, because local arrays need literals. Up to the capacity k
//! is a uniform. A greater k needs other code, which is generated once per bucket (1, 2, 4, 8, …) and kept.

use fragbuf_codegen::Plan;

use crate::{Error, Pipelines, Renderer, Settings, Shaders};

/// A renderer for every k that the description supports.
pub struct Buckets<F> {
    shaders: F,
    settings: Settings,
    pipelines: Vec<Pipelines>,
    renderer: Renderer,
    /// The plan of the greatest capacity for which host steps decide.
    widest: Option<Plan>,
}

impl<F: FnMut(u32) -> Result<Shaders, Error>> Buckets<F> {
    /// Creates a renderer for `k`. `shaders` generates the shaders for a capacity; it is called once per bucket.
    pub async fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        settings: &Settings,
        k: u32,
        mut shaders: F,
    ) -> Result<Self, Error> {
        let pipelines = Pipelines::new(device, &shaders(bucket(k))?, settings).await?;
        let mut renderer = Renderer::with(device, queue, &pipelines, settings).await?;
        renderer.switch_pipelines(&pipelines, k).await?;
        Ok(Buckets { shaders, settings: settings.clone(), pipelines: vec![pipelines], renderer, widest: None })
    }

    /// Applies what earlier frames have decided, as [`Renderer::decide`] does, up to the capacity of the bucket of `most`: another k may need
    /// the pipelines of another bucket. An error changes nothing.
    pub async fn decide(&mut self, most: u32) -> Result<(), Error> {
        let capacity = bucket(most.max(1));
        if self.widest.as_ref().is_none_or(|plan| plan.capacity() != capacity) {
            self.widest = Some((self.shaders)(capacity)?.plan);
        }
        let (lag, values) = self.renderer.next_values(self.widest.as_ref()).await?;
        match values.k().filter(|k| bucket(*k) != self.renderer.capacity()) {
            Some(k) => {
                self.set_k(k).await?;
                self.renderer.lag = lag;
                Ok(())
            }
            None => self.renderer.apply_lagged(lag, values).await,
        }
    }

    /// Returns the renderer. Its [`Renderer::set_k`] stays within the bucket.
    pub fn renderer(&mut self) -> &mut Renderer {
        &mut self.renderer
    }

    /// Sets the number of fragments per pixel from the next frame on: by a uniform within a bucket, by other pipelines across
    /// buckets. An error changes nothing.
    pub async fn set_k(&mut self, k: u32) -> Result<(), Error> {
        if k == 0 {
            return Err(Error::BadValue { name: "k".to_owned(), expected: "at least 1".to_owned() });
        }
        let capacity = bucket(k);
        if self.renderer.capacity() == capacity {
            return self.renderer.set_k(k).await;
        }
        let known = self.pipelines.iter().find(|pipelines| pipelines.capacity() == capacity).cloned();
        let pipelines = match known {
            Some(pipelines) => pipelines,
            None => {
                let new = Pipelines::new(self.renderer.device(), &(self.shaders)(capacity)?, &self.settings).await?;
                if new.capacity() < k {
                    return Err(Error::BadValue {
                        name: "k".to_owned(),
                        expected: format!("at most the capacity of the shaders generated for it, {}", new.capacity()),
                    });
                }
                self.pipelines.push(new.clone());
                new
            }
        };
        self.renderer.switch_pipelines(&pipelines, k).await
    }
}

/// Returns the capacity for `k`. It is `k` itself if there is no greater power of two; generating shaders fails then.
fn bucket(k: u32) -> u32 {
    k.checked_next_power_of_two().unwrap_or(k)
}
