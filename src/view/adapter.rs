//! What there is to draw with and on, asked before an app is built that would panic without it.

use bevy::{render::settings::WgpuSettings, tasks::block_on};

/// What there is to draw with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterSummary {
    /// The adapter's name.
    pub name: String,
    /// Whether it draws without a GPU.
    pub software: bool,
}

/// There is nothing to draw with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no graphics adapter was found (a GPU with its Vulkan driver, or a software one such as Mesa's lavapipe)")]
pub struct NoAdapter;

/// The adapter that an app would draw with.
///
/// # Errors
/// If there is none.
pub fn adapter() -> Result<AdapterSummary, NoAdapter> {
    let settings = WgpuSettings::default();
    let backends = settings.backends.ok_or(NoAdapter)?;
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends;
    let instance = wgpu::Instance::new(descriptor);
    let options = wgpu::RequestAdapterOptions { power_preference: settings.power_preference, ..Default::default() };
    let info = block_on(instance.request_adapter(&options)).map_err(|_| NoAdapter)?.get_info();
    Ok(AdapterSummary { software: info.device_type == wgpu::DeviceType::Cpu, name: info.name })
}

/// There is no display that a window could open on.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoDisplay {
    /// Neither Wayland nor X11 is named.
    #[error("there is no display (DISPLAY names no X server)")]
    Unnamed,
    /// The X server that is named does not let anybody in.
    #[error("there is no display (the X server at DISPLAY={display} does not let us in: {reason})")]
    Refused {
        /// What is named.
        display: String,
        /// Why nobody comes in.
        reason: String,
    },
    /// A library is missing that a window needs.
    #[error("a window cannot be opened: the library {0} is missing or cannot be loaded")]
    Library(&'static str),
}

/// Whether there is a display that a window can open on: a Wayland compositor that answers, or an X server that lets us in, with the libraries of X11. Always on systems that always have one.
///
/// # Errors
/// If there is none.
pub fn display() -> Result<(), NoDisplay> {
    #[cfg(all(unix, not(target_os = "macos")))]
    if !(cfg!(feature = "wayland") && wayland_answers()) {
        return x11();
    }
    Ok(())
}

#[cfg(all(unix, not(target_os = "macos")))]
fn x11() -> Result<(), NoDisplay> {
    let display = std::env::var("DISPLAY").unwrap_or_default();
    if display.is_empty() {
        return Err(NoDisplay::Unnamed);
    }
    // A handshake, with the cookie that XAUTHORITY has for it; a socket alone may answer and then refuse.
    if let Err(reason) = x11rb::rust_connection::RustConnection::connect(Some(&display)) {
        return Err(NoDisplay::Refused { display, reason: reason.to_string() });
    }
    let libraries = [
        ("libX11", x11_dl::xlib::Xlib::open().is_ok()),
        ("libXcursor", x11_dl::xcursor::Xcursor::open().is_ok()),
        ("libX11-xcb", x11_dl::xlib_xcb::Xlib_xcb::open().is_ok()),
        ("libXi", x11_dl::xinput2::XInput2::open().is_ok()),
        ("libxkbcommon", xkbcommon_dl::xkbcommon_option().is_some()),
        ("libxkbcommon-x11", xkbcommon_dl::x11::xkbcommon_x11_option().is_some()),
    ];
    libraries.into_iter().find(|(_, opens)| !opens).map_or(Ok(()), |(name, _)| Err(NoDisplay::Library(name)))
}

#[cfg(all(unix, not(target_os = "macos")))]
fn wayland_answers() -> bool {
    let Some(display) = std::env::var_os("WAYLAND_DISPLAY").filter(|display| !display.is_empty()) else { return false };
    let folder = std::env::var_os("XDG_RUNTIME_DIR").unwrap_or_default();
    std::os::unix::net::UnixStream::connect(std::path::Path::new(&folder).join(display)).is_ok()
}
