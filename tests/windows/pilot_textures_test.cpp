// Tests whether a pilot with a mouse shows the study's own textures (docs/devices/mouse.md). The
// mouse's settings were not chosen with these textures.
#include "core/plane_geometry.hpp"
#include "device/drivers/mouse/path_observer.hpp"
#include "engine/extraction.hpp"
#include "engine/rendering/gains.hpp"
#include "protocols/session/exploration.hpp"
#include "stimuli/generator.hpp"
#include "support/catch.hpp"

namespace touchtrial {
namespace {

constexpr int kStrokes = 40;
constexpr int kSidePx = 300;  ///< 60 mm, more than any stroke's reach

/// Exemplars as a study with the default options presents them.
class PreparedTextures {
 public:
  PreparedTextures(const std::vector<std::string>& labels, int exemplar) {
    std::vector<engine::FieldView> views;
    for (const std::string& label : labels) {
      const GreyImage image =
          stimuli::generate_stimulus(label, stimuli::kDefaultStimuliSeed, kSidePx, exemplar);
      fields_.push_back(
          engine::make_texture_field(engine::extract_texture<double>(image, {}).texture, options_));
    }
    for (const engine::TextureField& field : fields_) views.push_back(field.view());
    const engine::StudyGains gains = engine::choose_gains(views, options_);
    for (std::size_t i = 0; i < views.size(); ++i) {
      models_.emplace_back(views[i], options_, gains.per_field[i]);
    }
  }

  [[nodiscard]] TextureMaker maker() const {
    return
        [this](std::size_t index) { return std::make_unique<session::ModelForce>(models_[index]); };
  }

 private:
  engine::RenderingOptions options_;
  std::vector<engine::TextureField> fields_;
  std::vector<engine::RenderingModel> models_;
};

TEST_CASE("an observer of the drawn path names textures as a study presents them") {
  struct Named {
    std::vector<std::string> labels;
    double same, other;  ///< at least, by the same picture and by another one
  };
  for (const auto& [labels, same, other] :
       {Named{{"brick", "cloth"}, 0.65, 0.4},
        Named{{"bark", "cloth", "pebbles", "straw", "brick"}, 0.45, 0.35}}) {
    CAPTURE(labels.size());
    const PreparedTextures learned(labels, 1);
    const PreparedTextures others(labels, 2);
    const auto share = [&](const PreparedTextures& named) {
      return share_named_rightly(labels.size(), kStrokes, {learned.maker(), 500'000},
                                 {named.maker(), 900'000});
    };
    CHECK(share(learned) >= same);
    const double by_other = share(others);
    CHECK(by_other >= other);
    // Of two it is hardly better than guessing.
    if (labels.size() == 2) CHECK(by_other < 0.7);
  }
}

}  // namespace
}  // namespace touchtrial
