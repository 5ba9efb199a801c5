#include "app/commands/test_texture.hpp"

#include "device/model/workspace_fit.hpp"
#include "engine/extraction.hpp"
#include "engine/rendering/gains.hpp"
#include "stimuli/generator.hpp"

#include <array>

namespace touchtrial::app {
namespace {

engine::TextureField bark_field(int side_px, const engine::RenderingOptions& options) {
  const GreyImage image = stimuli::generate_stimulus("bark", stimuli::kDefaultStimuliSeed, side_px);
  return engine::make_texture_field(engine::extract_texture<double>(image, {}).texture, options);
}

engine::RenderingOptions limited_options(double max_stiffness_n_per_mm) {
  engine::RenderingOptions options;
  for (double* const stiffness :
       {&options.stiffness_n_per_mm, &options.texture_stiffness_n_per_mm}) {
    *stiffness = device::limit_to_share(*stiffness, max_stiffness_n_per_mm);
  }
  return options;
}

}  // namespace

TestTexture::TestTexture(int side_px, double max_stiffness_n_per_mm)
    : options_(limited_options(max_stiffness_n_per_mm)), field_(bark_field(side_px, options_)) {
  const std::array fields = {field_.view()};
  gains_ = engine::choose_gains(fields, options_).per_field.front();
}

engine::RenderingModel TestTexture::texture() const {
  return {field_.view(), options_, gains_};
}

engine::RenderingModel TestTexture::wall() const {
  return {engine::FieldView{.geometry = plane()}, options_, engine::Gains{}};
}

}  // namespace touchtrial::app
