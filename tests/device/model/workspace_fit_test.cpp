#include "device/model/workspace_fit.hpp"

#include "core/errors.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

namespace touchtrial {
namespace {

using namespace device;

/// 1 px is 0.2 mm.
PlaneGeometry plane_of(double width_mm, double height_mm) {
  return {0.2, static_cast<int>(std::lround(height_mm * 5.0)),
          static_cast<int>(std::lround(width_mm * 5.0))};
}

/// A box about the device's origin.
Workspace box_of(double x_mm, double y_mm, double z_mm) {
  const Vec3 half = 0.5 * Vec3{x_mm, y_mm, z_mm};
  return {-1.0 * half, half};
}

Workspace ball_of(double radius_mm) {
  Workspace ball = box_of(2.0 * radius_mm, 2.0 * radius_mm, 2.0 * radius_mm);
  ball.shape = WorkspaceShape::ellipsoid;
  return ball;
}

DeviceUse use_at(Vec3 centre_mm) {
  DeviceUse use;
  use.centre_mm = centre_mm;
  return use;
}

Vec3 on_plane_mm(Vec3 device_mm, const PlanePlacement& placement) {
  return device::to_plane_direction(device_mm - placement.origin_mm, placement.orientation);
}

}  // namespace

TEST_CASE("a plane that fills a box but for the margin fits and a pixel more does not") {
  const Workspace box = box_of(60.0, 30.0, 50.0);
  CHECK(device::fit_plane(plane_of(50.0, 40.0), box).fits);
  CHECK_FALSE(device::fit_plane(plane_of(50.2, 40.0), box).fits);
  CHECK_FALSE(device::fit_plane(plane_of(50.0, 40.2), box).fits);
}

TEST_CASE("a horizontal plane lies in the middle with its first corner far and left") {
  const WorkspaceFit fit = device::fit_plane(plane_of(50.0, 40.0), box_of(160.0, 120.0, 70.0));
  REQUIRE(fit.placement.has_value());
  CHECK(fit.placement->orientation == PlaneOrientation::horizontal);
  CHECK(fit.placement->origin_mm == Vec3{-25.0, 0.0, -20.0});
  CHECK(on_plane_mm({0.0, 0.0, 0.0}, *fit.placement) == Vec3{25.0, 20.0, 0.0});
}

TEST_CASE("a vertical plane lies in the middle with its first corner high and left") {
  const WorkspaceFit fit = device::fit_plane(plane_of(50.0, 40.0), box_of(160.0, 120.0, 70.0), {},
                                             PlaneOrientation::vertical);
  REQUIRE(fit.placement.has_value());
  CHECK(fit.placement->origin_mm == Vec3{-25.0, 20.0, 0.0});
  CHECK(on_plane_mm({0.0, 0.0, 3.0}, *fit.placement) == Vec3{25.0, 20.0, 3.0});
}

TEST_CASE("orientation decides which side of the box a plane is measured against") {
  const Workspace desk = box_of(100.0, 40.0, 80.0);
  CHECK(device::fit_plane(plane_of(60.0, 60.0), desk, {}, PlaneOrientation::horizontal).fits);
  CHECK_FALSE(device::fit_plane(plane_of(60.0, 60.0), desk, {}, PlaneOrientation::vertical).fits);
  DeviceUse use;
  use.orientation = PlaneOrientation::vertical;
  CHECK_FALSE(device::fit_plane(plane_of(60.0, 60.0), desk, use).fits);
  CHECK(device::fit_plane(plane_of(60.0, 60.0), desk, use, PlaneOrientation::horizontal).fits);
}

TEST_CASE("a box that is too flat to lift a hand from the plane holds none") {
  CHECK(device::fit_plane(plane_of(20.0, 20.0), box_of(100.0, 10.0, 100.0)).fits);
  const WorkspaceFit flat = device::fit_plane(plane_of(20.0, 20.0), box_of(100.0, 9.8, 100.0));
  CHECK_FALSE(flat.fits);
  CHECK(flat.largest.width_px == 0);
  CHECK(flat.largest.height_px == 0);
}

TEST_CASE("a middle that the lab chose moves the plane and takes room away") {
  const Workspace box = box_of(100.0, 40.0, 100.0);
  const WorkspaceFit moved =
      device::fit_plane(plane_of(50.0, 50.0), box, use_at({20.0, -15.0, -20.0}));
  CHECK(moved.fits);
  CHECK(moved.placement->origin_mm == Vec3{-5.0, -15.0, -45.0});
  CHECK_FALSE(device::fit_plane(plane_of(50.0, 50.0), box, use_at({20.2, 0.0, 0.0})).fits);
  CHECK_FALSE(device::fit_plane(plane_of(50.0, 50.0), box, use_at({0.0, -15.2, 0.0})).fits);
}

TEST_CASE("a middle off the workspace counts from the workspace's own middle") {
  const Workspace shifted{{0.0, 0.0, 0.0}, {60.0, 40.0, 60.0}};
  const WorkspaceFit fit = device::fit_plane(plane_of(50.0, 50.0), shifted);
  CHECK(fit.fits);
  CHECK(fit.placement->origin_mm == Vec3{5.0, 20.0, 5.0});
}

TEST_CASE("a ball is smaller than the box around it") {
  // Corner of the 40 mm plane with its margin: 25, 25 and 5 mm from the middle, 35.7 mm in all.
  CHECK(device::fit_plane(plane_of(40.0, 40.0), ball_of(40.0)).fits);
  CHECK(device::fit_plane(plane_of(40.0, 40.0), ball_of(35.71)).fits);
  CHECK_FALSE(device::fit_plane(plane_of(40.0, 40.0), ball_of(35.70)).fits);
  // The default textures, 51.2 mm: 30.6, 30.6 and 5 mm, 43.6 mm in all.
  CHECK_FALSE(device::fit_plane(plane_of(51.2, 51.2), ball_of(40.0)).fits);
  CHECK(device::fit_plane(plane_of(51.2, 51.2), box_of(80.0, 80.0, 80.0)).fits);
}

TEST_CASE("the offered crop of a ball is the largest part that fits to the pixel") {
  const PlaneGeometry plane = plane_of(51.2, 51.2);
  const WorkspaceFit fit = device::fit_plane(plane, ball_of(40.0));
  // Half sides of 23.0 and 23.1 mm: (28.0^2 + 28.1^2 + 5^2) = 1598.6; 23.1 twice would be 1604.2.
  CHECK(fit.largest.width_px == 230);
  CHECK(fit.largest.height_px == 231);
  CHECK(fit.largest.pitch_mm == plane.pitch_mm);
  CHECK(device::fit_plane(fit.largest, ball_of(40.0)).fits);
}

TEST_CASE("no crop that is one pixel larger fits") {
  const PlaneGeometry plane = plane_of(80.0, 50.0);
  for (const Workspace& workspace : {ball_of(40.0), ball_of(31.0), box_of(61.0, 20.0, 47.3)}) {
    const PlaneGeometry crop = device::fit_plane(plane, workspace).largest;
    REQUIRE(crop.width_px > 0);
    CHECK(device::fit_plane(crop, workspace).fits);
    PlaneGeometry wider = crop;
    ++wider.width_px;
    PlaneGeometry higher = crop;
    ++higher.height_px;
    CHECK((crop.width_px == plane.width_px || !device::fit_plane(wider, workspace).fits));
    CHECK((crop.height_px == plane.height_px || !device::fit_plane(higher, workspace).fits));
  }
}

TEST_CASE("a device without a workspace takes any plane and is not placed") {
  const WorkspaceFit fit = device::fit_plane(plane_of(5000.0, 3000.0), std::nullopt);
  CHECK(fit.fits);
  CHECK_FALSE(fit.placement.has_value());
}

TEST_CASE("a session on a device that is too small is refused with numbers and a crop") {
  DeviceInfo device{.name = "falcon", .workspace = ball_of(40.0)};
  CHECK(device::placement_of(plane_of(40.0, 40.0), device, {}).has_value());
  CHECK_THAT(message_of<DeviceError>(
                 [&] { return device::placement_of(plane_of(51.2, 51.2), device, {}); }),
             names("51.2 256 80 230 231"));
  CHECK(refuses<DeviceError>(
      [&] {
        return device::placement_of(plane_of(40.0, 40.0), device, use_at({60.0, 0.0, 0.0}));
      },
      "centre_mm"));
}

TEST_CASE("a study is refused on a device that does not render its stiffness or damping") {
  DeviceInfo device{.name = "touch",
                    .max_stiffness_n_per_mm = static_cast<double>(0.4F),
                    .max_damping_n_s_per_mm = 0.004};
  CHECK(check_stiffness({0.3, 0.3, 0.003}, device).empty());
  CHECK(check_stiffness({9.0, 9.0, 9.0}, {}).empty());
  // A library gives its limit in single precision: the default wall is at it, not beyond.
  CHECK_THAT(check_stiffness({0.4, 0.3, 0.0}, device),
             names("rendering.stiffness_n_per_mm 0.4 N/mm 0.36"));
  const auto is_refused = [&](const RenderedStiffness& stiffness, const char* places) {
    return refuses<DeviceError>([&] { return check_stiffness(stiffness, device); }, places);
  };
  CHECK(is_refused({0.41, 0.3, 0.0}, "stiffness_n_per_mm 0.41 N/mm"));
  CHECK(is_refused({0.3, 0.5, 0.0}, "texture_stiffness_n_per_mm 0.5"));
  CHECK(is_refused({0.3, 0.3, 0.005}, "damping_n_s_per_mm 0.005"));
}

}  // namespace touchtrial
