// STL files as another program, admesh, reads them.

#include "flute_grinder/tool/stl.h"

#include "temp_folder.h"
#include "tool/solid_cases.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <memory>
#include <regex>

namespace grinder {
namespace test_stl {

using test_support::cylinder;
using test_support::SolidCase;
using units::kMillimetre;

/// What admesh says of a file.
class Admesh {
 public:
  explicit Admesh(const std::string& path) {
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(("admesh '" + path + "' 2>&1").c_str(), "r"), pclose);
    std::array<char, 256> buffer{};
    while (std::fgets(buffer.data(), static_cast<int>(buffer.size()), pipe.get())) text_ += buffer.data();
  }

  /// The figure behind a name.
  double figure(const std::string& name) const {
    std::smatch match;
    if (std::regex_search(text_, match, std::regex(name + " *: *([-+.e0-9]+)"))) return std::stod(match[1]);
    ADD_FAILURE() << name << " is not in:\n" << text_;
    return -1;
  }

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

void expectSound(const CutterSolid& solid) {
  const test_support::TempFolder folder;
  const std::string path = folder.path() / "cutter.stl";
  std::ofstream out(path, std::ios::binary);
  writeStl(out, solid);
  out.close();
  EXPECT_TRUE(out.good());
  const Admesh admesh(path);
  for (const char* wrong : {"Total disconnected facets", "Degenerate facets", "Edges fixed", "Facets removed",
                            "Facets added", "Facets reversed", "Backwards edges", "Normals fixed"}) {
    EXPECT_EQ(admesh.figure(wrong), 0) << admesh.text();
  }
  EXPECT_EQ(admesh.figure("Number of parts"), 1);
  const double volume = solid.volume() / (kMillimetre * kMillimetre * kMillimetre);
  EXPECT_NEAR(admesh.figure("Volume"), volume, 1e-4 * volume);
}

TEST(Stl, IsSoundToAnotherProgram) {
  for (const SolidCase& c : test_support::solidCases()) {
    SCOPED_TRACE(c.name);
    expectSound(cutterSolid(c.ground, {c.from, c.to}, {20, 32, 72}));
  }
}

}  // namespace test_stl
}  // namespace grinder
