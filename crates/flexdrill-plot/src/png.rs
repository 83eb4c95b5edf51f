//! Drawings as bitmaps.

use std::sync::Arc;

use resvg::{tiny_skia, usvg};

use crate::draw::{FONT, FONT_FAMILY, WIDTH};

/// Pixels per unit of a figure's width of 1080: 2160 pixels are 300 dpi over 183 mm, a page's width.
const PIXELS: f32 = 2.0;

/// Renders an SVG of [`crate::svg`]. `None` if it is not one, or has no size.
pub fn png(svg: &str) -> Option<Vec<u8>> {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_data(FONT.to_vec());
    fonts.set_sans_serif_family(FONT_FAMILY);
    let options = usvg::Options {
        fontdb: Arc::new(fonts),
        font_family: FONT_FAMILY.to_owned(),
        ..usvg::Options::default()
    };
    let tree = usvg::Tree::from_str(svg, &options).ok()?;
    let height = tree.size().height() / tree.size().width() * WIDTH as f32;
    let width = WIDTH as f32;
    let mut pixels = tiny_skia::Pixmap::new((PIXELS * width) as u32, (PIXELS * height).round() as u32)?;
    pixels.fill(tiny_skia::Color::WHITE);
    let scale = PIXELS * width / tree.size().width();
    resvg::render(
        &tree,
        tiny_skia::Transform::from_scale(scale, scale),
        &mut pixels.as_mut(),
    );
    pixels.encode_png().ok()
}
