// Only the pages of a field that the stylus touches are read. The test makes the others
// inaccessible, so that reading one would end the program.
#include "protocols/session/exploration.hpp"
#include "protocols/session/stroker.hpp"
#include "support/guarded_bytes.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial {
namespace {

using namespace engine;

constexpr int kSidePx = 500;

RenderingOptions options_of(ModelKind model) {
  return {.model = model};
}

Gains gains_of(ModelKind model) {
  return model == ModelKind::surface ? Gains{.height_mm = 0.005} : Gains{0.005, 0.005};
}

TextureField wavy_field(const RenderingOptions& options) {
  Plane<double> texture(kSidePx, kSidePx);
  for (int y = 0; y < kSidePx; ++y) {
    for (int x = 0; x < kSidePx; ++x) texture.at(y, x) = 20.0 * std::sin(0.4 * x + 0.1 * y);
  }
  return engine::make_texture_field(texture, options);
}

/// Pages of the pixels that interpolation at these positions needs.
std::set<std::size_t> pages_under(const record::Trace& trace, const PlaneGeometry& plane,
                                  int reach_before, int reach_behind, std::size_t bytes_a_pixel) {
  std::set<std::size_t> pages;
  const auto inside = [](int i) { return std::clamp(i, 0, kSidePx - 1); };
  for (const auto& sample : trace.samples) {
    if (!(sample.force_n.z > 0.0)) continue;
    const Vec2 px = plane.to_px(sample.position_mm.x, sample.position_mm.y);
    const int left = static_cast<int>(std::floor(px.x));
    const int top = static_cast<int>(std::floor(px.y));
    for (int y = top - reach_before; y <= top + reach_behind; ++y) {
      for (const int x : {left - reach_before, left + reach_behind}) {
        const auto pixel = static_cast<std::size_t>(inside(y)) * kSidePx + inside(x);
        pages.insert(pixel * bytes_a_pixel / page_size());
        pages.insert(((pixel + 1) * bytes_a_pixel - 1) / page_size());
      }
    }
  }
  return pages;
}

record::Trace explored(const RenderingModel& model, const PlaneGeometry& plane) {
  Stroker explorer(RandomStream(1, "field_pages_test"));
  record::Trace trace;
  session::ModelForce force(model);
  REQUIRE(session::VirtualExplorer().explore(force, plane, explorer, {}, trace).servo.end ==
          device::ServoEnd::hand_stopped);
  return trace;
}

/// The pages that ten seconds of exploration touch. Repeats the exploration with access to no other
/// page.
std::size_t touched_pages(ModelKind model, std::size_t& of) {
  const RenderingOptions options = options_of(model);
  const TextureField field = wavy_field(options);
  FieldView view = field.view();
  const PlaneGeometry plane = view.geometry;
  const record::Trace trace = explored(RenderingModel(view, options, gains_of(model)), plane);
  GuardedBytes guarded(std::as_bytes(view.heights));
  const auto pages = pages_under(trace, plane, 1, 2, sizeof(float));
  guarded.leave_only(pages);
  view.heights = guarded.as<float>();
  const record::Trace again = explored(RenderingModel(view, options, gains_of(model)), plane);
  REQUIRE(again.samples.size() == trace.samples.size());
  for (std::size_t i = 0; i < trace.samples.size(); ++i) {
    REQUIRE(again.samples[i].force_n == trace.samples[i].force_n);
  }
  of = guarded.pages();
  return pages.size();
}

TEST_CASE("ten seconds on a texture touch no page of its field but those under the stylus") {
  std::size_t of_surface = 0;
  std::size_t of_paper = 0;
  const std::size_t surface = touched_pages(ModelKind::surface, of_surface);
  const std::size_t paper = touched_pages(ModelKind::paper, of_paper);
  CAPTURE(surface, of_surface, paper, of_paper);
  CHECK(surface > 0);
  CHECK(surface < of_surface * 9 / 10);
  CHECK(paper > 0);
  CHECK(paper < of_paper * 9 / 10);
}

TEST_CASE("a hand without contact reads no page of a field") {
  const RenderingOptions options = options_of(GENERATE(ModelKind::paper, ModelKind::surface));
  const TextureField field = wavy_field(options);
  FieldView view = field.view();
  GuardedBytes guarded(std::as_bytes(view.heights));
  guarded.leave_only({});
  view.heights = guarded.as<float>();
  const RenderingModel model(view, options, gains_of(options.model));
  Bristle touch;
  for (int x_mm = 0; x_mm < 100; ++x_mm) {
    REQUIRE(model.force_n({1.0 * x_mm, 50.0, 0.5}, {0.0, 0.0, -100.0}, touch) == Vec3{});
  }
}

}  // namespace
}  // namespace touchtrial
