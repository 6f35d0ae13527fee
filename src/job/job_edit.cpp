#include "flute_grinder/job/job_edit.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <map>
#include <sstream>

namespace grinder {

namespace {

constexpr const char* kBom = "\xEF\xBB\xBF";  ///< byte order mark; yaml-cpp's positions do not count it

/// A value as the parser sees it.
struct Scalar {
  std::size_t at = 0;  ///< byte at which the value begins
  int line = 0;
  std::string value, tag;

  bool operator==(const Scalar& o) const { return value == o.value; }
};

struct Map {
  bool flow = false;
  std::size_t first_key = 0, next = 0;  ///< bytes at which the first key begins and at which the map's successor begins
  int column = 0;                       ///< column of the map's keys
};

/// The positions of all values in a YAML text, by paths such as "process.overtravel_mm[0]".
class Outline : public YAML::EventHandler {
 public:
  Outline(const std::string& text, std::string name)
      : name_(std::move(name)), size_(text.size()), bom_(text.rfind(kBom, 0) == 0 ? 3 : 0) {
    checkYaml(text, name_);
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    parser.HandleNextDocument(*this);
    leave(text.size());
  }

  const std::map<std::string, Scalar>& scalars() const { return scalars_; }
  const std::map<std::string, Map>& maps() const { return maps_; }

  [[noreturn]] void refuse(int line, const std::string& why) const {
    throw JobFileError(name_ + ":" + std::to_string(line + 1) + ": " + why);
  }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { value(mark, "", ""); }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, const std::string& text) override {
    value(mark, text, tag);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { value(mark, "", ""); }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    enter(mark, false);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value style) override {
    const std::string path = enter(mark, true);
    maps_[path].flow = style == YAML::EmitterStyle::Flow;
  }
  void OnSequenceEnd() override { levels_.pop_back(); }
  void OnMapEnd() override {
    left_.push_back(levels_.back().path);
    levels_.pop_back();
  }

 private:
  struct Level {
    std::string path;
    bool map;
    bool has_key;  ///< the key is read, its value is next
    std::string key;
    std::size_t count;  ///< number of keys or elements so far
  };

  std::size_t byte(const YAML::Mark& mark) const {
    const std::size_t at = bom_ + static_cast<std::size_t>(mark.pos);
    if (at > size_) refuse(mark.line, "is read as a longer text than it is: not UTF-8");
    return at;
  }

  /// Ends the maps left since the last value at a byte.
  void leave(std::size_t at) {
    for (const std::string& path : left_) maps_[path].next = at;
    left_.clear();
  }

  /// The path of the value that begins; its key, if it needs one, was read.
  std::string nextPath(const YAML::Mark& mark) {
    if (levels_.empty()) return "";
    Level& level = levels_.back();
    if (!level.map) return level.path + "[" + std::to_string(level.count++) + "]";
    if (!level.has_key) refuse(mark.line, "has a key that is not a word");
    level.has_key = false;
    return (level.path.empty() ? "" : level.path + ".") + level.key;
  }

  std::string enter(const YAML::Mark& mark, bool map) {
    leave(byte(mark));
    levels_.push_back({nextPath(mark), map, false, "", 0});
    return levels_.back().path;
  }

  void value(const YAML::Mark& mark, const std::string& text, const std::string& tag) {
    leave(byte(mark));
    if (!levels_.empty() && levels_.back().map && !levels_.back().has_key) {
      Level& level = levels_.back();
      if (level.count++ == 0) {
        maps_[level.path].first_key = byte(mark);
        maps_[level.path].column = mark.column;
      }
      level.has_key = true;
      level.key = text;
      return;
    }
    const std::string path = nextPath(mark);
    if (!scalars_.emplace(path, Scalar{byte(mark), mark.line, text, tag}).second) {
      refuse(mark.line, path + " appears twice");
    }
  }

  std::string name_;
  std::size_t size_, bom_;  ///< bytes of the text, and of the byte order mark at its start
  std::map<std::string, Scalar> scalars_;
  std::map<std::string, Map> maps_;
  std::vector<Level> levels_;
  std::vector<std::string> left_;
};

bool sameNumber(const std::string& a, const std::string& b) {
  double x = 0, y = 0;
  return YAML::convert<double>::decode(YAML::Node(a), x) && YAML::convert<double>::decode(YAML::Node(b), y) && x == y;
}

std::string stemOf(const std::string& key) {
  return key.substr(0, key.find('.') == std::string::npos ? 0 : key.rfind('.'));
}
std::string leafOf(const std::string& key) { return key.substr(key.rfind('.') + 1); }

class Editor {
 public:
  Editor(const std::string& text, const std::string& name)
      : text_(text), outline_(text, name), expected_(outline_.scalars()) {}

  std::string edited(const std::vector<JobEdit>& edits) {
    std::map<std::string, std::string> new_maps;
    for (const JobEdit& edit : edits) {
      const auto old = outline_.scalars().find(edit.key);
      if (old != outline_.scalars().end() && sameNumber(old->second.value, edit.value)) continue;
      expected_[edit.key].value = edit.value;
      const std::string stem = stemOf(edit.key);
      if (old != outline_.scalars().end()) {
        replace(old->second, edit.value);
      } else if (outline_.maps().count(stem) != 0) {
        insert(stem, leafOf(edit.key) + ": " + edit.value);
      } else {
        std::string& content = new_maps[stem];
        content += (content.empty() ? "" : ", ") + leafOf(edit.key) + ": " + edit.value;
      }
    }
    for (const auto& [path, content] : new_maps) insert(stemOf(path), leafOf(path) + ": {" + content + "}");
    return applied();
  }

  /// Whether a text has the edited numbers, and all other numbers unchanged.
  bool isRight(const Outline& result) const { return result.scalars() == expected_; }

 private:
  struct Change {
    std::size_t at, length;
    std::string text;
  };

  void replace(const Scalar& old, const std::string& value) {
    const bool quoted = old.at < text_.size() && (text_[old.at] == '"' || text_[old.at] == '\'');
    const std::size_t at = old.at + (quoted ? 1 : 0);
    const bool plain_tag = old.tag == "?" || old.tag == "!" || old.tag.empty();
    if (!plain_tag || old.value.empty() || text_.compare(at, old.value.size(), old.value) != 0) {
      outline_.refuse(old.line, "has a value that is not written as a plain number");
    }
    changes_.push_back({at, old.value.size(), value});
  }

  void insert(const std::string& path, const std::string& item) {
    const auto found = outline_.maps().find(path);
    if (found == outline_.maps().end()) outline_.refuse(0, path + " is missing");
    const Map& map = found->second;
    if (map.flow) {
      changes_.push_back({map.first_key, 0, item + ", "});
      return;
    }
    const std::string eol = text_.find("\r\n") != std::string::npos ? "\r\n" : "\n";
    const std::string line = std::string(static_cast<std::size_t>(map.column), ' ') + item;
    const std::size_t at = endOfContent(map.next);
    const bool after_line = at == 0 || text_[at - 1] == '\n';
    changes_.push_back({at, 0, after_line ? line + eol : eol + line});
  }

  /// The end of the last line before a byte that is neither blank nor a comment.
  std::size_t endOfContent(std::size_t before) const {
    std::size_t end = before == text_.size() ? before : text_.rfind('\n', before) + 1;
    while (end > 0) {
      const std::size_t previous = end < 2 ? std::string::npos : text_.rfind('\n', end - 2);
      const std::size_t start = previous == std::string::npos ? 0 : previous + 1;
      const std::size_t first = text_.find_first_not_of(" \t\r\n", start);
      if (first < end && text_[first] != '#') break;
      end = start;
    }
    return end;
  }

  std::string applied() {
    std::stable_sort(changes_.begin(), changes_.end(), [](const Change& a, const Change& b) { return a.at < b.at; });
    std::string result;
    std::size_t done = 0;
    for (const Change& change : changes_) {
      result.append(text_, done, change.at - done).append(change.text);
      done = change.at + change.length;
    }
    return result.append(text_, done);
  }

  const std::string& text_;
  Outline outline_;
  std::map<std::string, Scalar> expected_;
  std::vector<Change> changes_;
};

}  // namespace

std::string editJob(const std::string& text, const std::string& name, const std::vector<JobEdit>& edits) {
  Editor editor(text, name);
  std::string result = editor.edited(edits);
  const auto is_right = [&] {
    try {
      return editor.isRight(Outline(result, name));
    } catch (const JobFileError&) {
      return false;  // the edit has broken the YAML
    }
  };
  if (!is_right()) throw JobFileError(name + ": cannot be edited without changing something else");
  return result;
}

}  // namespace grinder
