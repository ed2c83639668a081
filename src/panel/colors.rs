//! The colours and the looks of the panel. Colours are those of Okabe and Ito, which people with any colour vision tell apart.

use bevy_egui::egui::{self, Color32, CornerRadius, FontId, Margin, Stroke, TextStyle, vec2};

/// All is well.
pub const GREEN: Color32 = Color32::from_rgb(0x2f, 0xb9, 0x8a);
/// Take care.
pub const AMBER: Color32 = Color32::from_rgb(0xe6, 0x9f, 0x00);
/// Wrong.
pub const RED: Color32 = Color32::from_rgb(0xf0, 0x6a, 0x28);
/// Behind the panel.
pub const BACKGROUND: Color32 = Color32::from_rgb(0x1d, 0x21, 0x24);
/// Behind fields and plots.
pub const WELL: Color32 = Color32::from_rgb(0x12, 0x15, 0x17);

/// The colours of lines, in order.
pub const SERIES: [Color32; 6] = [
    Color32::from_rgb(0x56, 0xb4, 0xe9),
    Color32::from_rgb(0xe6, 0x9f, 0x00),
    Color32::from_rgb(0x2f, 0xb9, 0x8a),
    Color32::from_rgb(0xcc, 0x79, 0xa7),
    Color32::from_rgb(0xf0, 0xe4, 0x42),
    Color32::from_rgb(0xd5, 0x5e, 0x00),
];

/// A colour from 0xRRGGBB.
pub fn rgb(color: u32) -> Color32 {
    let [_, red, green, blue] = color.to_be_bytes();
    Color32::from_rgb(red, green, blue)
}

/// The same colour, through which others are seen.
pub fn faint(color: Color32, opacity: f32) -> Color32 {
    color.gamma_multiply(opacity)
}

/// The frame around the panel.
pub fn frame() -> egui::Frame {
    egui::Frame::new().fill(BACKGROUND).inner_margin(Margin { left: 10, right: 4, top: 8, bottom: 8 })
}

/// Compact, quiet looks for everything inside of the panel.
pub fn style(ui: &mut egui::Ui) {
    let style = ui.style_mut();
    for (text, size) in
        [(TextStyle::Body, 13.0), (TextStyle::Button, 13.0), (TextStyle::Small, 10.5), (TextStyle::Heading, 17.0)]
    {
        style.text_styles.insert(text, FontId::proportional(size));
    }
    style.spacing.item_spacing = vec2(6.0, 3.0);
    style.spacing.button_padding = vec2(6.0, 2.0);
    style.spacing.interact_size.y = 19.0;
    style.spacing.slider_rail_height = 5.0;
    let visuals = &mut style.visuals;
    *visuals = egui::Visuals::dark();
    visuals.override_text_color = Some(Color32::from_gray(0xd8));
    visuals.weak_text_color = Some(Color32::from_gray(0x98));
    visuals.text_edit_bg_color = Some(WELL);
    visuals.extreme_bg_color = WELL;
    visuals.slider_trailing_fill = true;
    visuals.selection.bg_fill = Color32::from_rgb(0x24, 0x69, 0x96);
    visuals.selection.stroke = Stroke::new(1.0, Color32::WHITE);
    for widget in [&mut visuals.widgets.inactive, &mut visuals.widgets.hovered, &mut visuals.widgets.active] {
        widget.corner_radius = CornerRadius::same(4);
    }
}
