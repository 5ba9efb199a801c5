#include "protocols/session/exploration.hpp"

#include "protocols/session/prompt_participant.hpp"
#include "protocols/session/simulated_exploration.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/session/tiny_study.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <limits>
#include <optional>

namespace touchtrial {
namespace {

/// Explores as simulated participants do, and keeps what was felt.
class Explorer final : public session::PromptParticipant {
 public:
  explicit Explorer(const session::SubjectModel& subject) : subject_(subject) {}

  void see_pictures(const std::vector<std::string>&) override {}
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry& plane) override {
    RandomStream random(1, "exploration_test");
    return hand_.emplace(session::make_exploring_hand(subject_, plane, random));
  }
  void feel(const device::ServoSample& sample) noexcept override { felt.push_back(sample); }
  [[nodiscard]] session::ParticipantAnswer answer() override { return {}; }

  std::vector<device::ServoSample> felt;

 private:
  const session::SubjectModel& subject_;
  std::optional<device::SimulatedHand> hand_;
};

TEST_CASE("on a flat texture a hand keeps contact, steady to 0.02 N, 0.5 s after landing") {
  session::SubjectModel subject;
  subject.push_n = GENERATE(0.3, 0.7, 2.0);
  subject.explore_s = 3.0;
  const engine::RenderingOptions rendering;
  const engine::TextureField field = engine::make_texture_field(Plane<double>(120, 120), rendering);
  const engine::RenderingModel model(field.view(), rendering, {0.01, 0.01});
  Explorer explorer(subject);
  store::Trace trace;
  const session::Exploration done =
      session::VirtualExplorer().explore(model, field.view().geometry, explorer, {}, trace);
  REQUIRE(done.servo.end == device::ServoEnd::hand_stopped);
  REQUIRE(trace.samples.size() == 3000);
  std::size_t landed = 0;
  while (!(trace.samples.at(landed).force_n.z > 0.0)) ++landed;
  for (std::size_t i = landed + 500; i < trace.samples.size(); ++i) {
    REQUIRE(std::abs(trace.samples[i].force_n.z - subject.push_n) < 0.02);
  }
}

TEST_CASE("the trace and the participant get the same samples") {
  const TinyStudy study;
  const session::StimulusSource source(study.pack(), study.key().study.rendering);
  session::SubjectModel subject;
  subject.explore_s = 0.5;
  Explorer explorer(subject);
  store::Trace trace;
  const engine::RenderingModel& model = source.model(study.key().stimuli.front().code);
  static_cast<void>(session::VirtualExplorer().explore(model, source.plane(), explorer, {}, trace));
  REQUIRE(trace.samples.size() == explorer.felt.size());
  for (std::size_t i = 0; i < trace.samples.size(); ++i) {
    REQUIRE(trace.samples[i].position_mm == explorer.felt[i].position_mm);
    REQUIRE(trace.samples[i].force_n == explorer.felt[i].force_n);
  }
  CHECK(trace.rate_hz == 1000.0);
}

TEST_CASE("the time of landing is the same on every texture") {
  const TinyStudy study;
  const session::StimulusSource source(study.pack(), study.key().study.rendering);
  session::SubjectModel subject;
  subject.explore_s = 1.0;
  std::vector<std::chrono::nanoseconds> landings;
  for (const design::KeyedStimulus& keyed : study.key().stimuli) {
    Explorer explorer(subject);
    store::Trace trace;
    const session::Exploration done = session::VirtualExplorer().explore(
        source.model(keyed.code), source.plane(), explorer, {}, trace);
    REQUIRE(done.landed_at);
    landings.push_back(*done.landed_at);
  }
  CHECK(landings.size() == 5);
  CHECK(landings.front() > std::chrono::milliseconds(50));
  for (const auto landing : landings) CHECK(landing == landings.front());
}

TEST_CASE("when time is up the plane fades under the hand") {
  session::SubjectModel subject;
  const engine::RenderingOptions rendering;
  const engine::TextureField field = engine::make_texture_field(Plane<double>(120, 120), rendering);
  const engine::RenderingModel model(field.view(), rendering, {});
  Explorer explorer(subject);
  store::Trace trace;
  const device::ServoOptions options{.limit_ticks = 2000, .fade_ticks = 100};
  const session::Exploration done =
      session::VirtualExplorer().explore(model, field.view().geometry, explorer, options, trace);
  CHECK(done.servo.end == device::ServoEnd::time_limit);
  REQUIRE(trace.samples.size() == 2100);
  CHECK(trace.samples[1999].force_n.z == Approx(0.7).margin(0.02));
  CHECK(trace.samples[2099].force_n == Vec3{});
}

TEST_CASE("stimuli of different sizes are explored on the part that all have") {
  const TempFolder folder;
  const engine::RenderingOptions rendering;
  const engine::TextureField wide = engine::make_texture_field(Plane<double>(40, 90), rendering);
  const engine::TextureField high = engine::make_texture_field(Plane<double>(70, 60), rendering);
  engine::PackManifest manifest{std::string(64, 'a'), {}};
  manifest.entries.push_back({"aaaaaaaaaaaaaaaa",
                              engine::write_field(folder.path(), "aaaaaaaaaaaaaaaa", wide.view()),
                              {},
                              {}});
  manifest.entries.push_back({"bbbbbbbbbbbbbbbb",
                              engine::write_field(folder.path(), "bbbbbbbbbbbbbbbb", high.view()),
                              {},
                              {}});
  engine::write_manifest(folder.path(), manifest);
  const session::StimulusSource source(engine::Pack(folder.path()), rendering);
  CHECK(source.plane().height_px == 40);
  CHECK(source.plane().width_px == 60);
}

TEST_CASE("a pack of one model is refused by a study of the other") {
  const TinyStudy study;
  engine::RenderingOptions rendering = study.key().study.rendering;
  rendering.model = engine::ModelKind::surface;
  CHECK_THROWS_WITH(session::StimulusSource(study.pack(), rendering),
                    Catch::Contains("is of another rendering model than the study"));
}

TEST_CASE("a code that the pack does not have is an error that names it") {
  const TinyStudy study;
  const session::StimulusSource source(study.pack(), study.key().study.rendering);
  CHECK_THROWS_WITH(source.model("0123456789abcdef"), Catch::Contains("0123456789abcdef"));
}

}  // namespace
}  // namespace touchtrial
