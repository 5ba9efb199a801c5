#include "app/device_test/test_texture.hpp"

#include "engine/extraction.hpp"
#include "engine/rendering/gains.hpp"
#include "stimuli/generator.hpp"

#include <array>

namespace touchtrial {
namespace {

TextureField bark(int side_px, const RenderingOptions& options) {
  const GreyImage image = generate_stimulus("bark", kDefaultStimuliSeed, side_px);
  return make_texture_field(extract_texture<double>(image, {}).texture, options);
}

}  // namespace

TestTexture::TestTexture(int side_px) : field_(bark(side_px, options_)) {
  const std::array fields = {field_.view()};
  gains_ = choose_gains(fields, options_).of_field.front();
}

RenderingModel TestTexture::texture() const noexcept {
  return {field_.view(), options_, gains_};
}

RenderingModel TestTexture::wall() const noexcept {
  return {FieldView{.geometry = plane()}, options_, Gains{}};
}

}  // namespace touchtrial
