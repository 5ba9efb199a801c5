#include "stimuli/import/import.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/hash.hpp"
#include "core/random.hpp"
#include "engine/image_file.hpp"
#include "engine/image_samples.hpp"
#include "stimuli/import/photographs.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/temp_folder.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

using namespace touchtrial;
using namespace touchtrial::engine;
using namespace touchtrial::stimuli;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// A picture for each number; no two parts of it are alike.
GreyImage noise(int height, int width, std::uint64_t number) {
  RandomStream random(number, "import test");
  GreyImage image(height, width);
  for (std::uint8_t& sample : image.samples()) {
    sample = static_cast<std::uint8_t>(random.below(200));
  }
  return image;
}

/// A temporary folder with photographs in `album/`.
struct Album {
  Album() { fs::create_directory(photographs()); }
  [[nodiscard]] fs::path photographs() const { return folder.path() / "album"; }
  void add(const std::string& name, const GreyImage& image) const {
    make_folder((photographs() / name).parent_path());
    write_png(photographs() / name, image);
  }
  [[nodiscard]] ImportOptions options() const {
    ImportOptions options;
    options.photographs = photographs();
    options.study = folder.path() / "study.json";
    options.size_px = 20;
    options.crops = 3;
    return options;
  }
  /// Everything but the album, by name.
  [[nodiscard]] std::set<std::string> written() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder.path())) {
      names.insert(entry.path().filename().string());
    }
    names.erase("album");
    return names;
  }
  /// Expects that an import is refused and writes nothing.
  /// \return the reason; all faults of photographs
  [[nodiscard]] std::string refusal(const ImportOptions& options) const {
    const std::set<std::string> before = written();
    std::string reason = "not refused";
    try {
      static_cast<void>(import_photographs(options));
    } catch (const UnusablePhotographs& error) {
      reason.clear();
      for (const std::string& fault : error.faults()) reason += fault + " | ";
    } catch (const Error& error) {
      reason = error.what();
    }
    CHECK(written() == before);
    CHECK(std::ranges::count(reason, '\n') == 0);
    return reason;
  }
  [[nodiscard]] std::string refusal() const { return refusal(options()); }
  [[nodiscard]] json read(const std::string& name) const {
    return json::parse(text_of(read_file(folder.path() / name)));
  }

  TempFolder folder;
};

/// Two photographs that are fit for three crops of 20 pixels.
struct TwoPhotographs : Album {
  TwoPhotographs() {
    add("D9.png", noise(50, 70, 1));
    add("D10.png", noise(60, 45, 2));
  }
};

GreyImage part(const GreyImage& image, const json& crop) {
  GreyImage piece(crop.at("height").get<int>(), crop.at("width").get<int>());
  for (int y = 0; y < piece.height(); ++y) {
    for (int x = 0; x < piece.width(); ++x) {
      piece.at(y, x) = image.at(crop.at("y").get<int>() + y, crop.at("x").get<int>() + x);
    }
  }
  return piece;
}

}  // namespace

TEST_CASE("a flat folder makes a class of every file, in the order of their numbers") {
  const TwoPhotographs album;
  replace_file(album.photographs() / "notes.txt", "not a photograph");
  replace_file(album.photographs() / ".hidden.png", "not shown");
  const ImportReport report = import_photographs(album.options());
  REQUIRE(report.classes.size() == 2);
  CHECK(report.classes[0].label == "D9");
  CHECK(report.classes[1].label == "D10");
  CHECK(report.classes[0].crops == 3);
  CHECK_FALSE(report.classes[0].overlapping);
  CHECK(report.ignored == std::vector<std::string>{"notes.txt"});
  CHECK_THAT(report.warnings.front(), names("notes.txt"));
  CHECK(album.written() == std::set<std::string>{"study.json", "study.pictures"});
  const json study = album.read("study.json");
  CHECK(study.at("classes")[0].at("images")[2] == "study.pictures/D9-3.png");
  CHECK(study.at("seed") > 0);
}

TEST_CASE("crops are the parts of their photographs that the manifest says, and none is repeated") {
  const TwoPhotographs album;
  ImportOptions options = album.options();
  options.licence = "CC0-1.0";
  options.source = "a test";
  static_cast<void>(import_photographs(options));
  const json manifest = album.read("study.pictures/manifest.json");
  CHECK(manifest.at("format") == "touchtrial-import");
  CHECK(manifest.at("licence") == "CC0-1.0");
  CHECK(manifest.at("source") == "a test");
  REQUIRE(manifest.at("photographs").size() == 2);
  for (const json& photograph : manifest.at("photographs")) {
    const fs::path file = album.photographs() / photograph.at("file").get<std::string>();
    CHECK(photograph.at("sha256") == to_hex(sha256_of_file(file)));
  }
  REQUIRE(manifest.at("pictures").size() == 6);
  std::set<std::string> digests;
  for (const json& picture : manifest.at("pictures")) {
    const fs::path file =
        album.folder.path() / "study.pictures" / picture.at("file").get<std::string>();
    const GreyImage photograph =
        read_grey_image(album.photographs() / picture.at("photograph").get<std::string>());
    CHECK(read_grey_image(file) == part(photograph, picture.at("crop")));
    CHECK(picture.at("sha256") == to_hex(sha256_of_file(file)));
    digests.insert(picture.at("pixels_sha256").get<std::string>());
  }
  CHECK(digests.size() == 6);
}

TEST_CASE("a folder of folders makes a class of every folder and uses all its photographs") {
  const Album album;
  album.add("bark/one.png", noise(40, 40, 1));
  album.add("bark/two.png", noise(20, 20, 2));
  album.add("tree rings/a.png", noise(64, 30, 3));
  const ImportReport report = import_photographs(album.options());
  REQUIRE(report.classes.size() == 2);
  CHECK(report.classes[0].label == "bark");
  CHECK(report.classes[0].photographs == 2);
  CHECK(report.classes[1].label == "tree rings");
  const json manifest = album.read("study.pictures/manifest.json");
  std::set<std::string> used;
  for (const json& picture : manifest.at("pictures")) used.insert(picture.at("photograph"));
  CHECK(used == std::set<std::string>{"bark/one.png", "bark/two.png", "tree rings/a.png"});
}

TEST_CASE("the same photographs and seed give the same files, another seed other crops") {
  const TwoPhotographs album;
  std::vector<std::string> manifests;
  for (const std::uint64_t seed : {5, 5, 6}) {
    ImportOptions options = album.options();
    options.seed = seed;
    options.replace = true;
    static_cast<void>(import_photographs(options));
    manifests.push_back(text_of(read_file(album.folder.path() / "study.pictures/manifest.json")) +
                        text_of(read_file(options.study)));
  }
  CHECK(manifests[0] == manifests[1]);
  CHECK(manifests[0] != manifests[2]);
}

TEST_CASE("photographs of known resolution are resampled to feel life-size") {
  const Album album;
  album.add("a.png", noise(160, 200, 1));
  album.add("b.png", noise(200, 160, 2));
  ImportOptions options = album.options();
  options.pixels_per_mm = 10.0;  // at 0.2 mm a pixel: half the size
  static_cast<void>(import_photographs(options));
  const json manifest = album.read("study.pictures/manifest.json");
  CHECK(manifest.at("photographs")[0].at("scale") == 0.5);
  CHECK(manifest.at("photographs")[0].at("width_px") == 200);
  // The mean of four independent pixels varies half as much as one pixel.
  CHECK(manifest.at("pictures")[0].at("rms_grey").get<double>() ==
        Approx(200 / std::sqrt(12.0) / 2).epsilon(0.1));
  options.pixels_per_mm = 0.1;
  options.replace = true;
  CHECK_THROWS_AS(import_photographs(options), UnusablePhotographs);
  options.pixels_per_mm.reset();
  options.pixels_per_mm_of_files = true;
  CHECK_THROWS_AS(import_photographs(options), UnusablePhotographs);
}

TEST_CASE("equalised pictures have the levels that the manifest promises") {
  const TwoPhotographs album;
  ImportOptions options = album.options();
  options.equalise = LevelEqualising::both;
  static_cast<void>(import_photographs(options));
  const json manifest = album.read("study.pictures/manifest.json");
  CHECK(manifest.at("equal_mean_grey") == 128.0);
  const GreyImage picture = read_grey_image(album.folder.path() / "study.pictures/D10-1.png");
  double sum = 0.0;
  for (const std::uint8_t grey : picture.samples()) sum += grey;
  CHECK(sum / static_cast<double>(picture.size()) == Approx(128.0).margin(0.5));
}

TEST_CASE("crops that overlap, or features of an odd size, are warned about") {
  const Album album;
  album.add("fine.png", noise(30, 50, 1));
  GreyImage ramp(60, 60);
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 60; ++x) ramp.at(y, x) = static_cast<std::uint8_t>(2 * x + y);
  }
  album.add("ramp.png", ramp);
  album.add("soft.png", noise(30, 50, 2));
  const ImportReport report = import_photographs(album.options());
  std::string all;
  for (const std::string& warning : report.warnings) all += warning + "\n";
  CHECK_THAT(all, names("fine 1"));
  CHECK_THAT(all, names("fine 1 0.622 0.638"));
  CHECK_THAT(all, names("ramp"));
  CHECK_THAT(all, names("4"));
}

TEST_CASE("photographs that are too small or too few are refused with numbers that would do") {
  const TwoPhotographs album;
  ImportOptions options = album.options();
  options.size_px = 40;
  CHECK_THAT(album.refusal(options), names("3 --crops 2 --size 30"));
  options.size_px = 46;
  CHECK_THAT(album.refusal(options), names("D10.png 45 60 46 46"));
  fs::remove(album.photographs() / "D9.png");
  CHECK_THAT(album.refusal(), names("1 D10 2"));
  fs::remove(album.photographs() / "D10.png");
  CHECK_THAT(album.refusal(), names(album.photographs().string()));
  options.photographs = album.folder.path() / "nowhere";
  CHECK_THAT(album.refusal(options), names("nowhere"));
}

TEST_CASE("equal photographs are refused, whether their bytes or their pixels are equal") {
  const TwoPhotographs album;
  fs::copy_file(album.photographs() / "D9.png", album.photographs() / "E.png");
  CHECK_THAT(album.refusal(), names("E.png"));
  const GreyImage twin = read_grey_image(album.photographs() / "D9.png");
  std::string pgm = "P5 70 50 255\n";
  pgm.append(twin.samples().begin(), twin.samples().end());
  fs::remove(album.photographs() / "E.png");
  replace_file(album.photographs() / "E.pgm", pgm);
  CHECK_THAT(album.refusal(), names("E.pgm"));
}

TEST_CASE("photographs that cannot be read or felt are refused by name") {
  const TwoPhotographs album;
  replace_file(album.photographs() / "E.heic", std::string("\0\0\0\x18"
                                                           "ftypheic",
                                                           12));
  CHECK_THAT(album.refusal(), names("E.heic HEIF AVIF"));
  fs::remove(album.photographs() / "E.heic");
  replace_file(album.photographs() / "E.jpg", "hostile");
  CHECK_THAT(album.refusal(), names("E.jpg"));
  fs::remove(album.photographs() / "E.jpg");
  album.add("E.png", GreyImage(40, 40, 77));
  CHECK_THAT(album.refusal(), names("E.png"));
}

TEST_CASE("all photographs and names that cannot be used are named at once") {
  Album album;
  album.add("a/one.png", noise(50, 50, 1));
  album.add("b/one.png", noise(50, 50, 2));
  album.add("b/latin\xe9.png", noise(50, 50, 3));
  replace_file(album.photographs() / "a" / "two.jpg", "hostile");
  replace_file(album.photographs() / "b" / "two.webp", "RIFF1234WEBPVP8 ");
  fs::copy_file(album.photographs() / "a" / "one.png", album.photographs() / "b" / "twin.png");
  album.add("A/one.png", noise(50, 50, 4));
  album.add("NA/small.png", noise(19, 50, 5));
  album.add("c/d/one.png", noise(50, 50, 6));
  replace_file(album.photographs() / "beside.jpg", "hostile");
  const std::string reason = album.refusal();
  CHECK(std::ranges::count(reason, '|') == 9);
  for (const char* fault :
       {"two.jpg", "latin", "twin.png", "two.webp", "\"a\"", "NA", "small.png", "beside.jpg"}) {
    CHECK_THAT(reason, holds_text(fault));
  }
  const Album other;
  for (const char* name : {"T1_01", "T2-01", "line\nbreak_1", "NA_1"}) {
    other.add(name + std::string(".png"), noise(50, 50, std::hash<std::string>()(name)));
  }
  replace_file(other.photographs() / "T3_01.png", "hostile");
  ImportOptions options = other.options();
  options.names = "{class}_#";
  CHECK(std::ranges::count(other.refusal(options), '|') == 4);
  CHECK_THAT(other.refusal(options), names("NA"));
}

TEST_CASE("crops lie where a photograph is opaque, and the list and the manifest say so") {
  const TwoPhotographs album;
  Bytes pixels;  // 60 x 50 of grey and alpha, opaque from x 20 and y 10 on
  for (int i = 0; i < 50 * 60; ++i) {
    pixels.push_back(static_cast<std::uint8_t>(1 + i % 251));
    pixels.push_back(i % 60 >= 20 && i / 60 >= 10 ? 255 : 0);
  }
  replace_file(album.photographs() / "E.tif",
               samples::Tiff(60, 50, pixels).with(258, {8, 8}).with(277, {2}).bytes());
  ImportOptions options = album.options();
  const ImportReport report = import_photographs(options);
  CHECK_THAT(report.warnings.front(), names("40 40 20 10"));
  CHECK(album.read("study.pictures/manifest.json").at("remarks") == report.warnings);
  for (const char* file : {"E-1.png", "E-2.png", "E-3.png"}) {
    const GreyImage crop = read_grey_image(album.folder.path() / "study.pictures" / file);
    CHECK(std::ranges::count(crop.samples(), 0) == 0);
  }
  options.size_px = 45;
  options.replace = true;
  CHECK_THAT(album.refusal(options), names("E.tif 40 40"));
}

TEST_CASE("the files of an album are of the classes in their names") {
  const Album album;
  for (const char* name : {"T10_01", "T2_01", "T2_02", "T10_2"}) {
    album.add(std::string(name) + ".png", noise(50, 50, std::hash<std::string>()(name)));
  }
  ImportOptions options = album.options();
  options.names = "{class}_#";
  const ImportReport report = import_photographs(options);
  REQUIRE(report.classes.size() == 2);
  CHECK(report.classes[0].label == "T2");
  CHECK(report.classes[1].label == "T10");
  CHECK(report.classes[1].photographs == 2);
  options.replace = true;
  options.names = "T#_{class}";
  CHECK(import_photographs(options).classes.size() == 3);
  for (const char* bad : {"no class", "{class}{class}"}) {
    options.names = bad;
    CHECK_THROWS_AS(import_photographs(options), UsageError);
  }
  options.names = "{class}-#";
  CHECK_THROWS_AS(import_photographs(options), UnusablePhotographs);
}

TEST_CASE("a photograph is recognised by its first bytes, regardless of its extension") {
  const TwoPhotographs album;
  album.add("E.png", noise(50, 50, 9));
  fs::rename(album.photographs() / "E.png", album.photographs() / "E.picture");
  const ImportReport report = import_photographs(album.options());
  CHECK(report.classes.size() == 3);
  CHECK(report.ignored.empty());
}

TEST_CASE("names that cannot be labels are refused, and labels that look alike") {
  const TwoPhotographs album;
  const auto refused = [&](const std::string& name) {
    album.add(name, noise(50, 50, 9));
    const std::string reason = album.refusal();
    fs::remove(album.photographs() / name);
    return reason;
  };
  CHECK_THAT(refused("d9.png"), names("d9"));
  CHECK_THAT(refused("D9.PNG"), names("D9"));
  CHECK_THAT(refused("\xef\xbc\xa4"
                     "9.png"),
             names("9"));  // a wide D
  album.add("oak.png", noise(50, 50, 7));
  CHECK_THAT(refused("\xd0\xbe\xd0\xb0\xd0\xba.png"),  // of Cyrillic letters
             names("oak.png"));
  CHECK_THAT(refused(" D.png"), names("D"));
  CHECK_THAT(refused("latin\xe9.png"), names("UTF-8"));
  album.add("No\xc3\xabl.png", noise(50, 50, 8));
  CHECK(refused("Noe\xcc\x88l.png") != "not refused");
  album.add("folder/E.png", noise(50, 50, 9));
  CHECK_THAT(album.refusal(), names("D9.png"));
}

TEST_CASE("folders of classes that are empty or nested are refused") {
  const Album album;
  album.add("a/one.png", noise(50, 50, 1));
  fs::create_directory(album.photographs() / "b");
  CHECK_THAT(album.refusal(), names("b"));
  album.add("b/c/two.png", noise(50, 50, 2));
  CHECK_THAT(album.refusal(), names("c"));
}

TEST_CASE("nothing is replaced unasked, and never a folder that no import wrote") {
  const TwoPhotographs album;
  ImportOptions options = album.options();
  static_cast<void>(import_photographs(options));
  CHECK_THAT(album.refusal(options), names("study.json"));
  fs::remove(options.study);
  CHECK_THAT(album.refusal(options), names("study.pictures"));
  options.replace = true;
  options.crops = 2;
  CHECK_NOTHROW(import_photographs(options));
  CHECK_FALSE(path_exists(album.folder.path() / "study.pictures/D9-3.png"));
  options.pictures = album.folder.path() / "precious";
  fs::create_directory(options.pictures);
  replace_file(options.pictures / "notes.txt", "mine");
  CHECK_THAT(album.refusal(options), holds_text("precious"));
  CHECK(path_exists(options.pictures / "notes.txt"));
}

TEST_CASE("a failed replacement leaves the earlier import as it was") {
  const TwoPhotographs album;
  ImportOptions options = album.options();
  static_cast<void>(import_photographs(options));
  const std::string before = text_of(read_file(options.study));
  album.add("E.png", GreyImage(40, 40, 77));
  options.replace = true;
  CHECK_THAT(album.refusal(options), names("E.png"));
  CHECK(text_of(read_file(options.study)) == before);
  CHECK(path_exists(album.folder.path() / "study.pictures/D9-3.png"));
}

TEST_CASE("outputs among the photographs, or at impossible paths, are refused") {
  const TwoPhotographs album;
  ImportOptions options = album.options();
  options.study = album.photographs() / "study.json";
  CHECK(album.refusal(options) != "not refused");
  options.study = album.folder.path() / "study.txt";
  CHECK_THAT(album.refusal(options), names("study.txt .json"));
  options.study = album.folder.path() / "missing" / "study.json";
  CHECK_THAT(album.refusal(options), names("missing"));
  options = album.options();
  options.pictures = album.folder.path();
  options.replace = true;
  CHECK(album.refusal(options) != "not refused");
  options = album.options();
  options.licence = "\xff";
  CHECK_THAT(album.refusal(options), names("UTF-8"));
}

TEST_CASE("options out of range are refused") {
  const TwoPhotographs album;
  const auto refused = [&](const auto& change) {
    ImportOptions options = album.options();
    change(options);
    return album.refusal(options);
  };
  CHECK_THAT(refused([](ImportOptions& o) { o.size_px = 15; }), holds_text("--size"));
  CHECK_THAT(refused([](ImportOptions& o) { o.crops = 0; }), holds_text("--crops"));
  CHECK_THAT(refused([](ImportOptions& o) { o.pitch_mm = 0.0; }), holds_text("--pitch-mm"));
  CHECK_THAT(refused([](ImportOptions& o) { o.pixels_per_mm = -1.0; }),
             holds_text("--pixels-per-mm"));
}

TEST_CASE("numbers in names count as numbers") {
  CHECK(naturally_before("D2", "D10"));
  CHECK_FALSE(naturally_before("D10", "D2"));
  CHECK(naturally_before("D02", "D10"));
  CHECK(naturally_before("a", "b2"));
  CHECK(naturally_before("D", "D1"));
  CHECK(naturally_before("D01", "D1"));
  CHECK(naturally_before("z", "\xc3\xa4"));  // on every platform
  CHECK_FALSE(naturally_before("D1", "D1"));
}
