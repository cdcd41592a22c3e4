//! What a plan requires of a device: its version, extensions, features and limits, by the names of the manifest.
//!
//! Input: a plan and the values of its symbols. Output: the features and extensions to request, or an error that
//! names everything that the device lacks.

use std::collections::BTreeSet;
use std::ffi::CStr;

use ash::{ext, khr, vk};
use fragbuf_follow::Values;
use fragbuf_follow::manifest::{Limit, Plan, Requirements};

use crate::context::{Context, failed};
use crate::{Error, TARGET};

/// Features of Vulkan 1.1, and of the extensions that a manifest may require.
#[derive(Clone, Copy, Default)]
pub struct Features {
    core: vk::PhysicalDeviceFeatures,
    atomics: vk::PhysicalDeviceShaderAtomicInt64Features<'static>,
    interlock: vk::PhysicalDeviceFragmentShaderInterlockFeaturesEXT<'static>,
}

impl Features {
    /// Returns a feature by its name in Vulkan.
    fn member(&mut self, name: &str) -> Option<&mut vk::Bool32> {
        Some(match name {
            "fragmentStoresAndAtomics" => &mut self.core.fragment_stores_and_atomics,
            "vertexPipelineStoresAndAtomics" => &mut self.core.vertex_pipeline_stores_and_atomics,
            "independentBlend" => &mut self.core.independent_blend,
            "sampleRateShading" => &mut self.core.sample_rate_shading,
            "geometryShader" => &mut self.core.geometry_shader,
            "shaderInt64" => &mut self.core.shader_int64,
            "shaderBufferInt64Atomics" => &mut self.atomics.shader_buffer_int64_atomics,
            "shaderSharedInt64Atomics" => &mut self.atomics.shader_shared_int64_atomics,
            "fragmentShaderPixelInterlock" => &mut self.interlock.fragment_shader_pixel_interlock,
            "fragmentShaderSampleInterlock" => &mut self.interlock.fragment_shader_sample_interlock,
            _ => return None,
        })
    }

    /// Returns the features of these names.
    pub fn requested(names: &[String]) -> Result<Self, Error> {
        let mut features = Features::default();
        for name in names {
            let member = features.member(name);
            *member.ok_or_else(|| Error(format!("the manifest requires `{name}`, which this host does not know")))? =
                vk::TRUE;
        }
        Ok(features)
    }

    /// Returns the features that a device has.
    fn of(context: &Context, extensions: &[String]) -> Self {
        let mut features = Features::default();
        let mut query = features.chain(extensions);
        // SAFETY: the chain has structs of Vulkan 1.1 and of extensions of the device only.
        unsafe { context.instance.get_physical_device_features2(context.physical, &mut query) };
        features.core = query.features;
        features
    }

    /// Returns the chain of structs: that of Vulkan 1.0, and one for each extension that has its own.
    pub fn chain(&mut self, extensions: &[String]) -> vk::PhysicalDeviceFeatures2<'_> {
        let has = |name: &CStr| extensions.iter().any(|extension| extension.as_bytes() == name.to_bytes());
        let mut chain = vk::PhysicalDeviceFeatures2::default().features(self.core);
        if has(khr::shader_atomic_int64::NAME) {
            chain = chain.push_next(&mut self.atomics);
        }
        if has(ext::fragment_shader_interlock::NAME) {
            chain = chain.push_next(&mut self.interlock);
        }
        chain
    }
}

/// Checks that the device has what the plan requires. Returns the requirements.
pub fn check(context: &Context, plan: &Plan, values: &Values) -> Result<Requirements, Error> {
    let requirements = plan.requirements(TARGET);
    let mut missing = missing_version(context, &requirements);
    // SAFETY: the device is one of the instance.
    let known = unsafe { context.instance.enumerate_device_extension_properties(context.physical) };
    let known = known.map_err(failed("the extensions of the device"))?;
    let known: BTreeSet<&[u8]> =
        known.iter().filter_map(|one| Some(one.extension_name_as_c_str().ok()?.to_bytes())).collect();
    let has = |extension: &&String| known.contains(extension.as_bytes());
    let lacking = requirements.extensions.iter().filter(|extension| !has(extension));
    missing.extend(lacking.map(|extension| format!("the extension `{extension}`")));
    let extensions: Vec<String> = requirements.extensions.iter().filter(has).cloned().collect();
    // Structs of extensions that the device lacks stay empty.
    let (mut supported, mut requested) =
        (Features::of(context, &extensions), Features::requested(&requirements.features)?);
    for name in &requirements.features {
        if supported.member(name) != requested.member(name) && !context.assume_features {
            missing.push(format!("the feature `{name}`"));
        }
    }
    missing.extend(missing_limits(&context.properties().limits, plan, values));
    if missing.is_empty() {
        return Ok(requirements);
    }
    Err(Error(format!(
        "the device `{}` lacks {}: choose another device or technique",
        context.name,
        missing.join(", ")
    )))
}

fn missing_version(context: &Context, requirements: &Requirements) -> Vec<String> {
    let version = context.properties().api_version;
    let present = (vk::api_version_major(version), vk::api_version_minor(version));
    let parsed = |text: &String| {
        let (major, minor) = text.split_once('.')?;
        Some((major.parse::<u32>().ok()?, minor.parse::<u32>().ok()?))
    };
    let needed = requirements.version.as_ref().and_then(parsed).unwrap_or((1, 1));
    if present < needed { vec![format!("Vulkan {}.{}", needed.0, needed.1)] } else { Vec::new() }
}

/// Describes the limits that a device does not meet. Formulas over symbols without a value are checked later: sizes
/// when memory is created, workgroups when they are dispatched.
fn missing_limits(limits: &vk::PhysicalDeviceLimits, plan: &Plan, values: &Values) -> Vec<String> {
    let missing = plan.limits.iter().filter_map(|limit| {
        let name = limit.vulkan.as_ref()?;
        let needed = match &limit.needed {
            serde_json::Value::String(formula) => values.value(formula, 0).ok()?,
            number => number.as_u64()?,
        };
        let present = present(limits, name, limit)?;
        let is_met = match name.ends_with("SampleCounts") {
            true => present & needed == needed,
            false => needed <= present,
        };
        (!is_met).then(|| format!("the limit `{name}` of {needed} (it is {present})"))
    });
    missing.collect()
}

/// Returns the value of a limit. `None`: it is younger than Vulkan 1.1, or depends on the rows of a slice. `memory`
/// and `draw` check these, when they create memory and record dispatches.
fn present(limits: &vk::PhysicalDeviceLimits, name: &str, limit: &Limit) -> Option<u64> {
    let least = |values: [u32; 3]| values.into_iter().min().unwrap_or(0);
    let axis = |values: [u32; 3]| match limit.webgpu.as_deref().and_then(|name| name.chars().last()) {
        Some('X') => values[0],
        Some('Y') => values[1],
        Some('Z') => values[2],
        _ => least(values),
    };
    let value = match name {
        "maxBoundDescriptorSets" => limits.max_bound_descriptor_sets,
        "maxFragmentCombinedOutputResources" => limits.max_fragment_combined_output_resources,
        "maxPerStageDescriptorStorageBuffers" => limits.max_per_stage_descriptor_storage_buffers,
        "maxPerStageDescriptorUniformBuffers" => limits.max_per_stage_descriptor_uniform_buffers,
        "maxPerStageDescriptorSampledImages" => limits.max_per_stage_descriptor_sampled_images,
        "maxUniformBufferRange" => limits.max_uniform_buffer_range,
        "maxImageDimension2D" => limits.max_image_dimension2_d,
        "maxColorAttachments" => limits.max_color_attachments,
        "maxVertexInputAttributes" => limits.max_vertex_input_attributes,
        "maxComputeWorkGroupSize" => axis(limits.max_compute_work_group_size),
        "maxComputeWorkGroupInvocations" => limits.max_compute_work_group_invocations,
        "maxComputeSharedMemorySize" => limits.max_compute_shared_memory_size,
        "framebufferColorSampleCounts" => limits.framebuffer_color_sample_counts.as_raw(),
        "framebufferDepthSampleCounts" => limits.framebuffer_depth_sample_counts.as_raw(),
        "sampledImageColorSampleCounts" => limits.sampled_image_color_sample_counts.as_raw(),
        "sampledImageIntegerSampleCounts" => limits.sampled_image_integer_sample_counts.as_raw(),
        "sampledImageDepthSampleCounts" => limits.sampled_image_depth_sample_counts.as_raw(),
        _ => return None,
    };
    Some(value.into())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by a panic")]

    use super::*;

    fn names(names: &[&str]) -> Vec<String> {
        names.iter().map(|name| (*name).to_owned()).collect()
    }

    /// Software drivers lack interlock, so its struct is checked without a device.
    #[test]
    fn the_chain_has_the_struct_of_each_extension() {
        let mut features = Features::requested(&names(&[
            "fragmentStoresAndAtomics",
            "shaderInt64",
            "shaderBufferInt64Atomics",
            "fragmentShaderPixelInterlock",
        ]))
        .unwrap();
        let (atomics, interlock) = (std::ptr::from_ref(&features.atomics), std::ptr::from_ref(&features.interlock));
        let chain = features.chain(&names(&["VK_KHR_shader_atomic_int64", "VK_EXT_fragment_shader_interlock"]));
        assert_eq!((chain.features.fragment_stores_and_atomics, chain.features.shader_int64), (vk::TRUE, vk::TRUE));
        assert_eq!(chain.features.independent_blend, vk::FALSE);
        assert_eq!(chain.p_next.cast_const(), interlock.cast());
        // SAFETY: both structs are part of `features`.
        let (interlock, atomics) = unsafe { (*interlock, *atomics) };
        assert_eq!(interlock.s_type, vk::StructureType::PHYSICAL_DEVICE_FRAGMENT_SHADER_INTERLOCK_FEATURES_EXT);
        assert_eq!((interlock.fragment_shader_pixel_interlock, interlock.fragment_shader_sample_interlock), (1, 0));
        assert_eq!((atomics.shader_buffer_int64_atomics, atomics.shader_shared_int64_atomics), (1, 0));
        assert!(features.chain(&[]).p_next.is_null());
    }

    #[test]
    fn an_unknown_feature_is_named() {
        let error = Features::requested(&names(&["rayTracing"])).err().unwrap();
        assert!(error.to_string().contains("`rayTracing`"), "{error}");
    }
}
