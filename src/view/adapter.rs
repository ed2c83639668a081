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

/// Whether there is a display that a window could open on: a Wayland or X11 socket that answers where one is named. True on systems
/// that always have one.
pub fn display_available() -> bool {
    #[cfg(all(unix, not(target_os = "macos")))]
    {
        x11_answers() || (cfg!(feature = "wayland") && wayland_answers())
    }
    #[cfg(not(all(unix, not(target_os = "macos"))))]
    {
        true
    }
}

#[cfg(all(unix, not(target_os = "macos")))]
fn x11_answers() -> bool {
    use std::os::unix::net::UnixStream;

    let Some(display) = std::env::var("DISPLAY").ok().filter(|display| !display.is_empty()) else { return false };
    let Some((host, number)) = display.rsplit_once(':') else { return false };
    let number = number.split('.').next().unwrap_or_default();
    // A display on another machine is taken at its word.
    if !host.is_empty() && host != "unix" {
        return true;
    }
    let socket = format!("/tmp/.X11-unix/X{number}");
    #[cfg(target_os = "linux")]
    {
        use std::os::linux::net::SocketAddrExt;
        let name = std::os::unix::net::SocketAddr::from_abstract_name(&socket);
        if name.is_ok_and(|name| UnixStream::connect_addr(&name).is_ok()) {
            return true;
        }
    }
    UnixStream::connect(&socket).is_ok()
}

#[cfg(all(unix, not(target_os = "macos")))]
fn wayland_answers() -> bool {
    let Some(display) = std::env::var_os("WAYLAND_DISPLAY").filter(|display| !display.is_empty()) else { return false };
    let folder = std::env::var_os("XDG_RUNTIME_DIR").unwrap_or_default();
    std::os::unix::net::UnixStream::connect(std::path::Path::new(&folder).join(display)).is_ok()
}
