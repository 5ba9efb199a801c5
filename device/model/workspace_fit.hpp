/// \file Whether a study's plane fits a device's workspace, and where it lies in it; and whether the
/// device renders its wall stably. Source: docs/decisions/0025-placement-never-rescales.md,
/// docs/devices/README.md.
#pragma once

#include "core/plane_geometry.hpp"
#include "device/device_settings.hpp"
#include "device/haptic_device.hpp"
#include "device/servo/placed_device.hpp"

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

/// What a study renders, in the terms in which makers limit it.
struct RenderedStiffness {
  double wall_n_per_mm = 0.0;     ///< of the wall
  double texture_n_per_mm = 0.0;  ///< the texture's stiffness budget
  double damping_n_s_per_mm = 0.0;
};

/// Of a device's limit: a stiffness or damping above this share leaves no room, and whatever may
/// choose its own stays below it.
inline constexpr double kStiffnessShare = 0.9;

/// Compares what a study renders with the device's own limits. It is never changed to fit: a
/// study's stiffness is registered, and the same for all its participants.
/// \return a warning if it is within 10 % of a limit, which is where the device may begin to
///   vibrate; else "", also if the device has no limits
/// \throws DeviceError with the remedy if it is beyond one
[[nodiscard]] std::string check_stiffness(const RenderedStiffness& rendered,
                                          const DeviceInfo& device);

/// \return a value that is to be rendered, or what the device's limit leaves of it
/// \param limit  0: not known
[[nodiscard]] constexpr double within_share(double value, double limit) noexcept {
  return limit > 0.0 && value > kStiffnessShare * limit ? kStiffnessShare * limit : value;
}

/// \return the device's limits of stiffness and damping in words; empty if it has none
[[nodiscard]] std::string rendering_limits_text(const DeviceInfo& device);

}  // namespace touchtrial::device
