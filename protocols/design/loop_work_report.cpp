#include "protocols/design/loop_work_report.hpp"

#include "core/random.hpp"
#include "engine/extraction.hpp"
#include "engine/image_file.hpp"
#include "engine/rendering/gains.hpp"
#include "engine/rendering/loop_work.hpp"
#include "protocols/design/prepare.hpp"
#include "protocols/design/stimulus_field.hpp"
#include "protocols/design/study_sections.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchtrial::design {
namespace {

constexpr int kLoopsOfStimulus = 50;
constexpr double kLargestMm = 10.0;
constexpr double kSmallestMm = 1.0;

/// A loop that is followed on every model and stimulus.
struct Loop {
  double size_mm = 0.0;
  double direction = 0.0;
  Vec2 place;  ///< position, as a share of the room around the loop on the plane
};

std::vector<Loop> random_loops() {
  RandomStream random(1, "loops");
  std::vector<Loop> loops(kLoopsOfStimulus);
  for (Loop& loop : loops) {
    loop.size_mm = random.uniform(kSmallestMm, kLargestMm);
    loop.direction = random.uniform(0.0, 2.0 * std::numbers::pi);
    loop.place = {random.uniform(0.0, 1.0), random.uniform(0.0, 1.0)};
  }
  return loops;
}

/// The centre of a loop and half its size on a plane. Loops shrink to fit small planes.
struct Placed {
  Vec2 middle_mm;
  double radius_mm = 0.0;
};

Placed placed(const Loop& loop, const PlaneGeometry& plane) {
  const double shortest_mm = std::min(plane.width_mm(), plane.height_mm());
  const double size_mm = std::min(loop.size_mm, shortest_mm);
  const auto along = [&](double share, double side_mm) {
    return 0.5 * size_mm + share * (side_mm - size_mm);
  };
  return {{along(loop.place.x, plane.width_mm()), along(loop.place.y, plane.height_mm())},
          0.5 * size_mm};
}

/// Magnitudes of the work along all loops so far, mJ.
struct Works {
  std::vector<double> planar;
  std::vector<double> press_slide_lift;
};

void go_round(const engine::RenderingModel& model, const PlaneGeometry& plane, double depth_mm,
              double air_mm, Works& works) {
  for (const Loop& loop : random_loops()) {
    const auto [middle_mm, radius_mm] = placed(loop, plane);
    const auto circle = engine::circle_path({middle_mm.x, middle_mm.y, -depth_mm}, radius_mm);
    works.planar.push_back(std::abs(engine::loop_work_mj(model, circle)));
    const Vec2 half_mm = radius_mm * Vec2{std::cos(loop.direction), std::sin(loop.direction)};
    const auto slide =
        engine::press_slide_lift_path(middle_mm - half_mm, middle_mm + half_mm, air_mm, -depth_mm);
    works.press_slide_lift.push_back(std::abs(engine::loop_work_mj(model, slide)));
  }
}

LoopWork summary_of(std::vector<double> works) {
  std::ranges::sort(works);
  return {works[works.size() / 2], works.back()};
}

std::vector<Plane<double>> textures_of(const Study& study) {
  std::vector<Plane<double>> textures;
  for (int c = 0; c < static_cast<int>(study.classes.size()); ++c) {
    const auto& images = study.classes[static_cast<std::size_t>(c)].images;
    for (int e = 0; e < static_cast<int>(images.size()); ++e) {
      const GreyImage grey =
          engine::read_grey_image(study.folder / images[static_cast<std::size_t>(e)]);
      for (int m = 0; m < study.presented_methods(); ++m) {
        const engine::ExtractionOptions method = method_of(study, {c, e, m});
        textures.push_back(engine::extract_texture<double>(grey, method).texture);
      }
    }
  }
  return textures;
}

/// A height above the whole stimulus, for the way back through the air.
double air_mm(engine::FieldView field, const engine::RenderingOptions& options,
              engine::Gains gains) {
  const double paper_mm =
      gains.normal_n * (field.highest - options.reference_grey) / options.stiffness_n_per_mm;
  const double surface_mm = gains.height_mm * field.highest;
  return 1.0 + std::max({0.0, paper_mm, surface_mm});
}

ModelLoopWork loop_work_under(const engine::RenderingOptions& options,
                              const std::vector<Plane<double>>& textures) {
  std::vector<engine::TextureField> fields;
  for (const auto& texture : textures)
    fields.push_back(engine::make_texture_field(texture, options));
  std::vector<engine::FieldView> views;
  for (const engine::TextureField& field : fields) views.push_back(field.view());
  const engine::StudyGains gains = engine::choose_gains(views, options);
  Works works;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const engine::RenderingModel model(views[i], options, gains.of_field[i]);
    go_round(model, views[i].geometry, engine::kStatedLoadN / options.stiffness_n_per_mm,
             air_mm(views[i], options, gains.of_field[i]), works);
  }
  return {options.model, summary_of(works.planar), summary_of(works.press_slide_lift),
          static_cast<int>(works.planar.size())};
}

}  // namespace

std::vector<ModelLoopWork> loop_work_of(const Study& study) {
  check_images_exist(study);
  const std::vector<Plane<double>> textures = textures_of(study);
  std::vector<ModelLoopWork> works;
  for (const Named<engine::ModelKind>& model : kModelNames) {
    engine::RenderingOptions options = study.rendering;
    options.model = model.value;
    options.gains.reset();
    options.friction = 0.0;
    works.push_back(loop_work_under(options, textures));
  }
  return works;
}

}  // namespace touchtrial::design
