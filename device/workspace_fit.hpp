/// \file Whether a study's plane fits a device's workspace, and where it then lies. Source:
/// docs/decisions/0025-placement-never-rescales.md.
#pragma once

#include "core/plane_geometry.hpp"
#include "device/device_settings.hpp"
#include "device/haptic_device.hpp"
#include "device/placed_device.hpp"

#include <optional>
#include <string>

namespace touchtrial::device {

/// Room that is kept on every side of the plane, above it and below it, mm: a hand overshoots the
/// edge, lifts off, and presses into the wall.
inline constexpr double kWorkspaceMarginMm = 5.0;

/// Where a plane would lie, and how much of it the device reaches.
struct WorkspaceFit {
  bool fits = false;
  /// Nothing: the device speaks the plane frame itself and is not to be wrapped.
  std::optional<PlanePlacement> placement;
  /// The largest part of the plane that fits, about the same middle, at the same pitch: the plane
  /// itself if it fits; of no pixels if not even one fits.
  PlaneGeometry largest;
};

/// Lays the plane's middle where `use` says, else in the middle of the workspace, which is where a
/// box and an ellipsoid have the most room. Never rescales.
/// \param plane  > 0 pixels and pitch
/// \param workspace  nothing: everything fits, see DeviceInfo::workspace
/// \param orientation  nothing: that of `use`, else horizontal
[[nodiscard]] WorkspaceFit fit_plane(const PlaneGeometry& plane,
                                     const std::optional<Workspace>& workspace,
                                     const DeviceUse& use = {},
                                     std::optional<PlaneOrientation> orientation = std::nullopt);

/// The same, for who needs it to fit: a session, before its first trial.
/// \param device  names the device in the error
/// \throws DeviceError with the plane's size, the workspace's, and the crop that would fit
[[nodiscard]] std::optional<PlanePlacement> placement_of(const PlaneGeometry& plane,
                                                         const DeviceInfo& device,
                                                         const DeviceUse& use);

/// One line: why the plane does not fit, in numbers, and what would. \pre not fit.fits
[[nodiscard]] std::string misfit_text(const std::string& device, const PlaneGeometry& plane,
                                      const Workspace& workspace, const WorkspaceFit& fit);

}  // namespace touchtrial::device
