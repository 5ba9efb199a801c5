#include "app/test_texture.hpp"

#include "engine/extraction.hpp"
#include "engine/rendering/gains.hpp"
#include "stimuli/generator.hpp"

#include <array>

namespace touchtrial::app {
namespace {

engine::TextureField bark(int side_px, const engine::RenderingOptions& options) {
  const GreyImage image = stimuli::generate_stimulus("bark", stimuli::kDefaultStimuliSeed, side_px);
  return engine::make_texture_field(engine::extract_texture<double>(image, {}).texture, options);
}

}  // namespace

TestTexture::TestTexture(int side_px) : field_(bark(side_px, options_)) {
  const std::array fields = {field_.view()};
  gains_ = engine::choose_gains(fields, options_).of_field.front();
}

engine::RenderingModel TestTexture::texture() const noexcept {
  return {field_.view(), options_, gains_};
}

engine::RenderingModel TestTexture::wall() const noexcept {
  return {engine::FieldView{.geometry = plane()}, options_, engine::Gains{}};
}

}  // namespace touchtrial::app
