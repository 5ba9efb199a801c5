/// \file Places a study's plane in a device's workspace, and checks that the device renders the
/// study's stiffness stably. Source: docs/decisions/0025-placement-never-rescales.md,
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

/// The placement of a plane, and the part of it that the device reaches.
struct WorkspaceFit {
  bool fits = false;
  /// Nothing: the device uses the plane frame itself, so do not wrap it in a PlacedDevice.
  std::optional<PlanePlacement> placement;
  /// The largest part of the plane that fits, with the same middle and pitch; without pixels if not
  /// even one fits.
  PlaneGeometry largest;
};

/// Centres the plane at DeviceUse::centre_mm, by default the middle of the workspace, where boxes
/// and ellipsoids have the most room. Never rescales.
/// \param plane  pixels and pitch > 0
/// \param workspace  nothing: everything fits, see DeviceInfo::workspace
/// \param orientation  nothing: DeviceUse::orientation, by default horizontal
[[nodiscard]] WorkspaceFit fit_plane(const PlaneGeometry& plane,
                                     const std::optional<Workspace>& workspace,
                                     const DeviceUse& use = {},
                                     std::optional<PlaneOrientation> orientation = std::nullopt);

/// The same for a session, where the plane must fit.
/// \param device  names the device in the error
/// \return WorkspaceFit::placement
/// \throws DeviceError with misfit_text if it does not
[[nodiscard]] std::optional<PlanePlacement> placement_of(const PlaneGeometry& plane,
                                                         const DeviceInfo& device,
                                                         const DeviceUse& use);

/// \pre not fit.fits
/// \return one line with the sizes of plane and workspace, and the crop that would fit
[[nodiscard]] std::string misfit_text(const std::string& device, const PlaneGeometry& plane,
                                      const Workspace& workspace, const WorkspaceFit& fit);

/// A study's stiffness and damping, in the quantities that makers limit.
struct RenderedStiffness {
  double wall_n_per_mm = 0.0;     ///< of the wall
  double texture_n_per_mm = 0.0;  ///< the texture's stiffness budget
  double damping_n_s_per_mm = 0.0;
};

/// Share of a device's limit: a stiffness or damping above it may vibrate, so the program itself
/// never chooses more.
inline constexpr double kStiffnessShare = 0.9;

/// Compares a study's stiffness with the device's limits. It is never adjusted, because it is
/// registered and the same for all participants.
/// \return a warning if a value is above kStiffnessShare of its limit; else "", also if the device
///   has no limits
/// \throws DeviceError with the remedy if a value is beyond its limit
[[nodiscard]] std::string check_stiffness(const RenderedStiffness& rendered,
                                          const DeviceInfo& device);

/// \param limit  0: unknown
/// \return the value, reduced to kStiffnessShare of the limit if above it
[[nodiscard]] constexpr double limit_to_share(double value, double limit) noexcept {
  return limit > 0.0 && value > kStiffnessShare * limit ? kStiffnessShare * limit : value;
}

/// \return the device's limits of stiffness and damping as text; empty if it has none
[[nodiscard]] std::string rendering_limits_text(const DeviceInfo& device);

}  // namespace touchtrial::device
