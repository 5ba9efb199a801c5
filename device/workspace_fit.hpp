/// \file Whether a study's plane fits a device's workspace, and where it lies in it. Source:
/// docs/decisions/0025-placement-never-rescales.md.
#pragma once

#include "core/plane_geometry.hpp"
#include "device/device_settings.hpp"
#include "device/haptic_device.hpp"
#include "device/placed_device.hpp"

#include <optional>
#include <string>

namespace touchtrial::device {

/// Free room on every side of the plane, above it and below it, mm: a hand overshoots the edge,
/// lifts off, and presses into the wall.
inline constexpr double kWorkspaceMarginMm = 5.0;

/// Where a plane lies, and how much of it the device reaches.
struct WorkspaceFit {
  bool fits = false;
  /// Nothing: the device uses the plane frame itself, so do not wrap it in a PlacedDevice.
  std::optional<PlanePlacement> placement;
  /// The largest part of the plane that fits, with the same middle and pitch: the plane itself if
  /// it fits; without pixels if not even one fits.
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

/// The same for a session, which needs the plane to fit.
/// \param device  names the device in the error
/// \return WorkspaceFit::placement
/// \throws DeviceError with the sizes of plane and workspace, and the crop that would fit
[[nodiscard]] std::optional<PlanePlacement> placement_of(const PlaneGeometry& plane,
                                                         const DeviceInfo& device,
                                                         const DeviceUse& use);

/// \pre not fit.fits
/// \return one line: why the plane does not fit, in numbers, and what would fit
[[nodiscard]] std::string misfit_text(const std::string& device, const PlaneGeometry& plane,
                                      const Workspace& workspace, const WorkspaceFit& fit);

}  // namespace touchtrial::device
