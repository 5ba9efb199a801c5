#include "protocols/session/subject_model_json.hpp"

#include "support/catch.hpp"

namespace touchtrial {
namespace {

TEST_CASE("a subject model that is written is read back as the same one, to the last digit") {
  session::SubjectModel model;
  model.weber = 0.1 + 0.2;
  model.weber_spread = 1.0 / 3.0;
  model.lapse = 0.02;
  model.lapse_spread = 0.7;
  model.position_bias = -1.5;
  model.position_bias_spread = 0.25;
  model.class_bias = {{"bark \"rough\"", -2.1}, {"Ton", 1e-3}};
  model.class_bias_spread = 0.125;
  model.label_swap = {{"bark \"rough\"", "Ton"}};
  model.explore_s = 4.25;
  model.push_n = 0.9;
  model.slowest_mm_s = 20.0;
  model.fastest_mm_s = 70.0;
  model.training_passes = 3;
  const std::string written = session::subject_model_json(model);
  const session::SubjectModel read = session::parse_subject_model(written, "written");
  CHECK(session::subject_model_json(read) == written);
  CHECK(read.weber == model.weber);
  CHECK(read.weber_spread == model.weber_spread);
  CHECK(read.class_bias == model.class_bias);
  CHECK(read.label_swap == model.label_swap);
  CHECK(read.position_bias_spread == 0.25);
  CHECK(read.training_passes == 3);
}

}  // namespace
}  // namespace touchtrial
