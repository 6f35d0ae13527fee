#include "node/offset_store.h"

#include "state_file_fixture.h"

#include <cmath>
#include <tuple>

// The work offsets on disk. How their file is kept is in test_state_file.cpp, how its fields are in test_journal.cpp.
namespace grinder {
namespace test_offset_store {

using namespace test_support;

const OffsetBasis kBasis{OffsetMethod::kProbe,
                         "my \"job\".yaml",
                         "a: b.yaml",
                         std::string(64, 'f'),
                         0.006,
                         0.1,
                         0.003,
                         0.006,
                         1.0 / 3,
                         -0.0015,
                         std::string(64, 'e'),
                         OperationKind::kPrimaryEnd,
                         OperationKind::kGash};
const WorkOffset kSome{0.1 + 0.2, "anna@grinder 3 °", 1.7e9 + 1.0 / 3, kBasis};
const WorkOffset kOther{-1000, "", 0};

class OffsetStoreTest : public StateFileTest {
 protected:
  static void set(OffsetStore& store, int axis, const WorkOffset& offset) {
    store.change([&](WorkOffsets& offsets) { offsets.axes[static_cast<std::size_t>(axis)] = offset; });
  }

  /// The file with two of the offsets set, one of them anew.
  std::string written() {
    OffsetStore store(path_, "/grinder");
    set(store, kY, {1, "", 1});
    set(store, kY, kSome);
    set(store, kA, kOther);
    return readFile(path_);
  }

  /// Why the content leaves offsets unknown; empty if it does not.
  std::string unknownWith(const std::string& content) {
    fill(path_, content);
    const OffsetStore store(path_, "/grinder");
    const bool zero = (store.offsets().values() == 0).any();
    EXPECT_FALSE(zero && !store.unknown().empty()) << "unknown, but 0";
    return store.unknown();
  }
};

TEST_F(OffsetStoreTest, WithoutAFileTheyWereNeverSet) {
  const OffsetStore store(path_, "/grinder");
  EXPECT_EQ(store.unknown(), "");
  for (const WorkOffset& offset : store.offsets().axes) {
    EXPECT_TRUE(std::tie(offset.value, offset.set_by, offset.set_at) == std::make_tuple(0, "", 0));
  }
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(OffsetStoreTest, KeepsAllThatWasSet) {
  written();
  {
    OffsetStore store(path_, "/grinder");
    store.change([](WorkOffsets& offsets) {
      offsets.axes[kY].mounting = 4;
      offsets.axes[kY].found_at = 1.25e9;
      offsets.wheel = {"a: b.yaml", std::string(64, 'f'), 0.1, 0.006, 5};
      offsets.tool = {std::string(64, 'd'), "my job.yaml", 0b101, TeethUnknown::kHomed, 7};
    });
  }
  const OffsetStore next(path_, "/grinder");
  EXPECT_EQ(next.unknown(), "");
  const WorkOffsets kept = next.offsets();
  EXPECT_TRUE((kept.values() == Axes(0, 0.1 + 0.2, 0, -1000)).all());
  const auto all = [](const WorkOffset& o) {
    const OffsetBasis& b = o.basis;
    return std::tie(o.value, o.set_by, o.set_at, b.method, b.job_name, b.wheel_name, b.wheel_digest, b.end_diameter,
                    b.wheel_diameter, b.wheel_width, b.wheel_rim, b.swivel, b.height, b.tool_digest, b.kind, b.before);
  };
  EXPECT_TRUE(all(kept.axes[kY]) == all(kSome));
  EXPECT_TRUE(all(kept.axes[kA]) == all(kOther));
  EXPECT_EQ(kept.axes[kY].mounting, 4U);
  EXPECT_EQ(kept.axes[kY].found_at, 1.25e9);
  EXPECT_TRUE(std::tie(kept.wheel.name, kept.wheel.digest, kept.wheel.diameter, kept.wheel.rim, kept.wheel.mounting) ==
              std::make_tuple("a: b.yaml", std::string(64, 'f'), 0.1, 0.006, 5U));
  EXPECT_TRUE(std::tie(kept.tool.digest, kept.tool.job_name, kept.tool.ground, kept.tool.unknown, kept.tool.clamping) ==
              std::make_tuple(std::string(64, 'd'), "my job.yaml", 0b101U, TeethUnknown::kHomed, 7U));
}

TEST_F(OffsetStoreTest, WhatIsInForceAtOnceIsOnTheDiskWithTheNextChange) {
  {
    OffsetStore store(path_, "/grinder");
    store.change([](WorkOffsets& offsets) { offsets.tool.digest = std::string(64, 'e'); });
    const std::string before = readFile(path_);
    store.changeAtOnce([](WorkOffsets& offsets) { offsets.tool.forget(TeethUnknown::kHomed); });
    EXPECT_EQ(store.offsets().tool.digest, "");
    EXPECT_EQ(readFile(path_), before);
    set(store, kY, kSome);
  }
  const WorkOffsets kept = OffsetStore(path_, "/grinder").offsets();
  EXPECT_EQ(kept.tool.digest, "");
  EXPECT_EQ(kept.tool.unknown, TeethUnknown::kHomed);
}

TEST_F(OffsetStoreTest, WrongFiguresUnderARightChecksumMakeThemUnknown) {
  const std::string good = written();
  const std::string body = good.substr(0, good.rfind("checksum: "));
  ASSERT_EQ(unknownWith(sealed(body)), "");
  const struct {
    std::string key, line, says;
  } lines[]{
      {"axis_y_m", "axis_y_m: 1000.1\n", "axis_y_m = 1000.1; allowed: -1000 to 1000"},
      {"axis_a_rad", "axis_a_rad: -.inf\n", "axis_a_rad = -inf; allowed: -1000 to 1000"},
      {"axis_x_set_at", "axis_x_set_at: -1\n", "axis_x_set_at = -1; allowed: 0 to 4000000000"},
      {"axis_x_set_at", "axis_x_set_at: .nan\n", "axis_x_set_at = nan; allowed: 0 to 4000000000"},
      {"axis_y_method", "axis_y_method: guessed\n",
       "axis_y_method = guessed; allowed: unknown, touch_off, probe, by_hand"},
      {"axis_y_height_m", "axis_y_height_m: .nan\n", "axis_y_height_m = nan; allowed: a finite number"},
      {"wheel_diameter_m", "wheel_diameter_m: .inf\n", "wheel_diameter_m = inf; allowed: a finite number"},
      {"tool_unknown", "tool_unknown: lost\n", "tool_unknown = lost; allowed: never_ground, clamped, homed, set"},
  };
  for (const auto& wrong : lines) {
    const std::string unknown = unknownWith(sealed(withLine(body, wrong.key, wrong.line)));
    EXPECT_NE(unknown.find(wrong.says), std::string::npos) << wrong.line << ": " << unknown;
  }
}

TEST_F(OffsetStoreTest, AfterDamageEachIsUnknownUntilItIsSet) {
  fill(path_, "damaged");
  {
    OffsetStore store(path_, "/grinder");
    EXPECT_TRUE(store.offsets().values().isNaN().all());
    EXPECT_EQ(store.unknown(), "unknown work offsets of axis_x, axis_y, axis_z, axis_a: file of work offsets " + path_ +
                                   ": its checksum is missing; set each of them, or touch off");
    set(store, kX, kSome);
    set(store, kZ, kOther);
    EXPECT_EQ(store.unknown().rfind("unknown work offsets of axis_y, axis_a: ", 0), 0U) << store.unknown();
  }
  OffsetStore next(path_, "/grinder");
  EXPECT_EQ(next.unknown(), "unknown work offsets of axis_y, axis_a; set each of them, or touch off");
  EXPECT_EQ(next.offsets().axes[kX].value, kSome.value);
  EXPECT_TRUE(std::isnan(next.offsets().axes[kY].value));
  set(next, kY, kSome);
  set(next, kA, {});
  EXPECT_EQ(next.unknown(), "");
}

TEST_F(OffsetStoreTest, AFileThatCannotBeUsedMakesThemUnknownAndIsReported) {
  std::filesystem::create_directory(path_);
  OffsetStore store(path_, "/grinder");
  EXPECT_NE(store.unknown(), "");
  EXPECT_THROW(set(store, kX, kSome), StateFileError);
  EXPECT_TRUE(store.offsets().values().isNaN().all());
  std::filesystem::remove(path_);
  set(store, kX, kSome);
  EXPECT_EQ(store.offsets().axes[kX].value, kSome.value);
}

TEST_F(OffsetStoreTest, WhatIsNotKeptIsNotSet) {
  const std::string good = written();
  OffsetStore store(path_, "/grinder");
  EXPECT_THROW(set(store, kY, {1000.1, "", 0}), StateFileError);
  EXPECT_THROW(set(store, kY, {0, std::string(1 << 16, 'n'), 0}), StateFileError);
  EXPECT_EQ(store.offsets().axes[kY].value, kSome.value);
  EXPECT_EQ(readFile(path_), good);
  {
    // Written to, but not opened to be synchronized.
    const Forbidden folder(folder_, std::filesystem::perms{0333});
    EXPECT_THROW(set(store, kY, kOther), StateFileError);
  }
  EXPECT_EQ(store.offsets().axes[kY].value, kSome.value);
  EXPECT_EQ(readFile(path_), good) << "a restart would set it";
  {
    OffsetStore first(folder_ + "/first", "/grinder");
    const Forbidden folder(folder_, std::filesystem::perms{0333});
    EXPECT_THROW(set(first, kY, kOther), StateFileError);
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ + "/first"));
}

}  // namespace test_offset_store
}  // namespace grinder
