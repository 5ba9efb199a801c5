#include "device/model/workspace_fit.hpp"

#include "core/errors.hpp"
#include "core/strict_json.hpp"

#include <array>
#include <cmath>
#include <cstdint>

namespace touchtrial::device {
namespace {

/// A plane that fits exactly must not be refused because of rounding.
constexpr double kToleranceMm = 1e-9;

Vec3 middle_of(const Workspace& workspace) {
  return 0.5 * (workspace.min_mm + workspace.max_mm);
}

/// The workspace reduced to one octant. It is symmetric about its middle, so only the corner of a
/// box that is furthest from the middle matters.
struct Reach {
  Vec3 offset_mm;  ///< distance of the plane's middle from the workspace's, each >= 0
  Vec3 half_mm;    ///< of the workspace
  WorkspaceShape shape;

  /// \param half_extent_mm  half the sides of a box about the plane's middle, device frame
  [[nodiscard]] bool contains(Vec3 half_extent_mm) const {
    const Vec3 corner = offset_mm + half_extent_mm;
    if (shape == WorkspaceShape::box) {
      return corner.x <= half_mm.x + kToleranceMm && corner.y <= half_mm.y + kToleranceMm &&
             corner.z <= half_mm.z + kToleranceMm;
    }
    const Vec3 share{corner.x / (half_mm.x + kToleranceMm), corner.y / (half_mm.y + kToleranceMm),
                     corner.z / (half_mm.z + kToleranceMm)};
    return norm(share) <= 1.0;
  }
};

Reach reach_around(Vec3 centre_mm, const Workspace& workspace) {
  const Vec3 offset = centre_mm - middle_of(workspace);
  return {{std::abs(offset.x), std::abs(offset.y), std::abs(offset.z)},
          0.5 * (workspace.max_mm - workspace.min_mm),
          workspace.shape};
}

/// \return half the size of the plane's box with its margins, device frame, each >= 0
Vec3 half_extent_mm(const PlaneGeometry& plane, PlaneOrientation orientation) {
  const Vec3 half =
      to_device_direction({plane.width_mm() / 2.0, plane.height_mm() / 2.0, 0.0}, orientation);
  return Vec3{std::abs(half.x), std::abs(half.y), std::abs(half.z)} +
         Vec3{kWorkspaceMarginMm, kWorkspaceMarginMm, kWorkspaceMarginMm};
}

std::int64_t pixels_of(const PlaneGeometry& plane) {
  return std::int64_t{plane.width_px} * plane.height_px;
}

/// \return the part with the largest area, in whole pixels, that fits. A wider part is never higher,
///   so one pass with growing width and falling height finds it.
PlaneGeometry largest_part(const PlaneGeometry& plane, const Reach& reach,
                           PlaneOrientation orientation) {
  PlaneGeometry best{plane.pitch_mm, 0, 0};
  PlaneGeometry part{plane.pitch_mm, plane.height_px, 1};
  for (; part.width_px <= plane.width_px; ++part.width_px) {
    while (part.height_px > 0 && !reach.contains(half_extent_mm(part, orientation)))
      --part.height_px;
    if (part.height_px == 0) break;
    if (pixels_of(part) > pixels_of(best)) best = part;
  }
  return best;
}

std::string rounded_text(double number) {
  return number_text(std::round(number * 10.0) / 10.0);
}

/// Rounds to the digits of a number in single precision.
std::string short_text(double number) {
  constexpr double kDigits = 1e6;
  return number_text(std::round(number * kDigits) / kDigits);
}

/// A parameter of the study's "rendering", and the device's limit for it; limit 0: unknown.
struct LimitedParameter {
  const char* key;
  const char* unit;
  double value;
  double limit;
};

std::string size_text(const PlaneGeometry& plane) {
  return rounded_text(plane.width_mm()) + " x " + rounded_text(plane.height_mm()) + " mm (" +
         std::to_string(plane.width_px) + " x " + std::to_string(plane.height_px) + " px)";
}

std::string workspace_text(const Workspace& workspace) {
  const Vec3 size = workspace.max_mm - workspace.min_mm;
  return rounded_text(size.x) + " x " + rounded_text(size.y) + " x " + rounded_text(size.z) +
         " mm" + (workspace.shape == WorkspaceShape::ellipsoid ? " (rounded)" : "");
}

}  // namespace

WorkspaceFit fit_plane(const PlaneGeometry& plane, const std::optional<Workspace>& workspace,
                       const DeviceUse& use, std::optional<PlaneOrientation> orientation) {
  if (!workspace) return {true, std::nullopt, plane};
  PlanePlacement placement;
  placement.orientation =
      orientation.value_or(use.orientation.value_or(PlaneOrientation::horizontal));
  const Vec3 centre_mm = use.centre_mm.value_or(middle_of(*workspace));
  placement.origin_mm =
      centre_mm - to_device_direction({plane.width_mm() / 2.0, plane.height_mm() / 2.0, 0.0},
                                      placement.orientation);
  const Reach reach = reach_around(centre_mm, *workspace);
  const bool fits = reach.contains(half_extent_mm(plane, placement.orientation));
  return {fits, placement, fits ? plane : largest_part(plane, reach, placement.orientation)};
}

std::string misfit_text(const std::string& device, const PlaneGeometry& plane,
                        const Workspace& workspace, const WorkspaceFit& fit) {
  const std::string remedy =
      fit.largest.width_px == 0
          ? "no part of it fits around that middle; move placement/centre_mm in the device settings"
          : "crop the pictures to " + std::to_string(fit.largest.width_px) + " x " +
                std::to_string(fit.largest.height_px) + " px around their middle (" +
                rounded_text(fit.largest.width_mm()) + " x " +
                rounded_text(fit.largest.height_mm()) +
                " mm), turn the plane, or use a larger device";
  return one_line(device + ": the plane of " + size_text(plane) +
                  " does not fit its workspace of " + workspace_text(workspace) + " with " +
                  number_text(kWorkspaceMarginMm) + " mm around it; " + remedy);
}

std::string rendering_limits_text(const DeviceInfo& device) {
  std::string text;
  if (device.max_stiffness_n_per_mm > 0.0) {
    text += "a stiffness of at most " + short_text(device.max_stiffness_n_per_mm) + " N/mm";
  }
  if (device.max_damping_n_s_per_mm > 0.0) {
    text += (text.empty() ? "" : " and ") + std::string("a damping of at most ") +
            short_text(device.max_damping_n_s_per_mm) + " N s/mm";
  }
  return text.empty() ? "" : "renders " + text;
}

std::string check_stiffness(const RenderedStiffness& rendered, const DeviceInfo& device) {
  const std::array parameters = {
      LimitedParameter{"stiffness_n_per_mm", "N/mm", rendered.wall_n_per_mm,
                       device.max_stiffness_n_per_mm},
      LimitedParameter{"texture_stiffness_n_per_mm", "N/mm", rendered.texture_n_per_mm,
                       device.max_stiffness_n_per_mm},
      LimitedParameter{"damping_n_s_per_mm", "N s/mm", rendered.damping_n_s_per_mm,
                       device.max_damping_n_s_per_mm}};
  std::string warning;
  for (const auto& [key, unit, value, limit] : parameters) {
    if (limit <= 0.0 || value <= kStiffnessShare * limit) continue;
    const std::string parameter_text =
        "rendering." + std::string(key) + " of " + short_text(value) + " " + unit;
    // Libraries report limits in single precision.
    if (value > limit * (1.0 + 1e-6)) {
      throw DeviceError(one_line(device.name + ": the study's " + parameter_text +
                                 " is beyond the device's own limit of " + short_text(limit) +
                                 ", where it may begin to oscillate; lower it in the study file "
                                 "before the study begins, or use a stiffer device"));
    }
    if (warning.empty()) {
      warning = one_line(device.name + ": the study's " + parameter_text +
                         " is at the device's own limit of " + short_text(limit) +
                         " and may vibrate; feel it with touchtrial device test, or plan at most " +
                         short_text(kStiffnessShare * limit));
    }
  }
  return warning;
}

std::optional<PlanePlacement> placement_of(const PlaneGeometry& plane, const DeviceInfo& device,
                                           const DeviceUse& use) {
  const WorkspaceFit fit = fit_plane(plane, device.workspace, use);
  if (!fit.fits) throw DeviceError(misfit_text(device.name, plane, *device.workspace, fit));
  return fit.placement;
}

}  // namespace touchtrial::device
