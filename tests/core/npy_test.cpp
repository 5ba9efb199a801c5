#include "core/npy.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <cmath>
#include <limits>

using namespace touchtrial;

TEST_CASE("an npy file gives back what was written, for every sample type") {
  const TempFolder folder;
  const auto path = folder.path() / "a.npy";
  Plane<double> plane(3, 5);
  for (std::size_t i = 0; i < plane.size(); ++i) plane.samples()[i] = static_cast<double>(i) - 2.5;
  write_npy(path, plane);
  const NpyArray array = read_npy(path);
  CHECK(array.type == "<f8");
  CHECK(array.shape == std::vector<int>{3, 5});
  CHECK(array.as_doubles() == std::vector<double>(plane.samples().begin(), plane.samples().end()));

  write_npy(path, converted<float>(plane));
  CHECK(read_npy(path).type == "<f4");
  CHECK(read_npy(path).as_doubles()[4] == 1.5);

  write_npy(path, GreyImage(1, 2, 200));
  CHECK(read_npy(path).type == "|u1");
  CHECK(read_npy(path).as_doubles() == std::vector<double>{200.0, 200.0});
}

TEST_CASE("an npy file's data start on a multiple of 64 bytes, as NumPy's own do") {
  const TempFolder folder;
  const auto path = folder.path() / "a.npy";
  const std::vector<float> samples(24);
  write_npy<float>(path, samples, {2, 6, 2});
  CHECK((read_file(path).size() - samples.size() * sizeof(float)) % 64 == 0);
  CHECK(read_npy(path).shape == std::vector<int>{2, 6, 2});
}

TEST_CASE("an npy file cut anywhere is refused with its name") {
  const TempFolder folder;
  const auto path = folder.path() / "whole.npy";
  write_npy(path, Plane<float>(4, 4, 1.0F));
  const Bytes whole = read_file(path);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto cut = folder.path() / "cut.npy";
    replace_file(cut, ByteView(whole).first(size));
    CHECK_THROWS_AS(read_npy(cut), FileError);
  }
}

TEST_CASE("an npy file that lies about its shape is refused before memory is spent") {
  const TempFolder folder;
  const auto path = folder.path() / "a.npy";
  write_npy(path, Plane<float>(4, 4, 1.0F));
  std::string text = text_of(read_file(path));
  for (const std::string shape : {"(9,4,)", "(-4,4,)", "(4;4,)", "(99999999999,)"}) {
    std::string altered = text;
    const std::size_t at = altered.find("(4,4,)");
    REQUIRE(at != std::string::npos);
    altered.replace(at, 6, shape);
    // Keep the header's length: take the difference out of its padding.
    const std::size_t padding = altered.find("  ");
    altered.erase(padding, shape.size() - 6);
    replace_file(path, altered);
    CHECK_THROWS_AS(read_npy(path), FileError);
  }
}

TEST_CASE("an npy file of another type or order is refused") {
  const TempFolder folder;
  const auto path = folder.path() / "a.npy";
  write_npy(path, Plane<float>(2, 2, 1.0F));
  const std::string text = text_of(read_file(path));
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string altered = text;
    altered.replace(altered.find(from), from.size(), to);
    replace_file(path, altered);
  };
  with("<f4", "<i4");
  CHECK_THROWS_AS(read_npy(path), FileError);
  with("<f4", ">f4");
  CHECK_THROWS_AS(read_npy(path), FileError);
  with("False", "True ");
  CHECK_THROWS_AS(read_npy(path), FileError);
}
