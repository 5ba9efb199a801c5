#include "engine/rendering/lateral_field.hpp"

#include "core/random.hpp"
#include "engine/rendering/field_statistics.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <stdexcept>

using namespace touchtrial;
using namespace touchtrial::engine;

TEST_CASE("the lateral field of either model has the rms that its figures have") {
  RandomStream random(1, "lateral field test");
  Plane<double> texture(24, 31);
  for (double& grey : texture.samples()) grey = random.uniform(-40, 40);
  for (const ModelKind model : {ModelKind::paper, ModelKind::surface}) {
    RenderingOptions options;
    options.model = model;
    const TextureField field = make_texture_field(texture, options);
    const Gains gains = model == ModelKind::paper ? Gains{0.01, 0.02, 0.0} : Gains{0.0, 0.0, 0.003};
    const LateralField lateral = lateral_field(field.view(), gains);
    double squares = 0.0;
    for (std::size_t i = 0; i < texture.size(); ++i) {
      squares +=
          std::pow(lateral.force.x.samples()[i], 2) + std::pow(lateral.force.y.samples()[i], 2);
    }
    const double rms_n =
        lateral.n_per_grey * std::sqrt(squares / static_cast<double>(texture.size()));
    CHECK(rms_n > 0.0);
    CHECK(rms_n == Approx(field_statistics(field.view(), gains, options).tangential_rms_n));
  }
}

TEST_CASE("an empty field has no lateral field") {
  CHECK_THROWS_AS((void)lateral_field(FieldView{}, Gains{}), std::invalid_argument);
}
