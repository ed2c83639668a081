//! Maps: images that repeat themselves over a surface, made in code.

use bevy::{
    asset::RenderAssetUsages,
    image::{ImageAddressMode, ImageFilterMode, ImageSampler, ImageSamplerDescriptor},
    prelude::*,
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
};

/// From how many sides of a slanted surface a map is looked up.
const ANISOTROPY: u16 = 8;

/// A map of so many pixels across and down, with all its smaller copies, so that it does not shimmer from afar. `pixel` gives its four numbers, 0 to 1: linear light
/// also where `format` keeps it as sRGB.
pub(super) fn image(size: [usize; 2], format: TextureFormat, pixel: impl Fn(usize, usize) -> [f32; 4]) -> Image {
    let [width, height] = size;
    let mut level: Vec<[f32; 4]> = (0..width * height).map(|i| pixel(i % width, i / width)).collect();
    let encoded = |[r, g, b, a]: [f32; 4]| match format.is_srgb() {
        true => Srgba::from(LinearRgba::new(r, g, b, a)).to_f32_array(),
        false => [r, g, b, a],
    };
    let bytes = |level: &[[f32; 4]]| -> Vec<u8> {
        level
            .iter()
            .flat_map(|&pixel| encoded(pixel))
            .map(|part| (part.clamp(0.0, 1.0) * 255.0).round() as u8)
            .collect()
    };
    let mut data = bytes(&level);
    let size = Extent3d { width: width as u32, height: height as u32, depth_or_array_layers: 1 };
    let usage = RenderAssetUsages::RENDER_WORLD;
    let mut image = Image::new(size, TextureDimension::D2, data.clone(), format, usage);
    let (mut wide, mut levels) = (width, 1);
    while wide > 2 && level.len() / wide > 1 {
        let half = wide / 2;
        level = (0..level.len() / 4)
            .map(|i| {
                let corner = i / half * 2 * wide + i % half * 2;
                let four = [corner, corner + 1, corner + wide, corner + wide + 1].map(|i| level[i]);
                core::array::from_fn(|part| four.iter().map(|pixel| pixel[part]).sum::<f32>() * 0.25)
            })
            .collect();
        data.extend(bytes(&level));
        (wide, levels) = (half, levels + 1);
    }
    image.texture_descriptor.mip_level_count = levels;
    image.data = Some(data);
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: ImageAddressMode::Repeat,
        address_mode_v: ImageAddressMode::Repeat,
        mipmap_filter: ImageFilterMode::Linear,
        anisotropy_clamp: ANISOTROPY,
        ..ImageSamplerDescriptor::linear()
    });
    image
}
