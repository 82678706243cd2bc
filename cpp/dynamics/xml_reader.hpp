#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace codesign::dynamics {

struct XmlAttribute {
  std::string_view name;
  std::string value;  // entities decoded
};

// Reads the tags of an XML text one after the other and refuses what is not well-formed. Text
// between tags, comments and processing instructions are skipped. A document type declaration is
// refused, so no entity beyond the five of XML exists and none can expand; nesting is bounded.
// Every error is a UrdfError naming the line.
class XmlReader {
 public:
  // The text must outlive the reader.
  explicit XmlReader(std::string_view text);

  // Moves to the next start or end tag; false at the end of the text. An element written <a/> gives
  // both. All start tags have been closed when it returns false.
  bool next();

  bool is_start() const { return is_start_; }
  std::string_view name() const { return name_; }
  const std::vector<XmlAttribute>& attributes() const { return attributes_; }  // of a start tag
  int depth() const { return depth_; }  // of the current element; the root has 1

  [[noreturn]] void fail(const std::string& reason) const;

 private:
  void skip_to_tag();
  void skip_past(std::string_view end, const char* what);
  void skip_space();
  std::string_view read_name();
  void read_attributes();
  std::string decode(std::string_view raw) const;
  bool at(std::string_view token) const { return text_.substr(position_).starts_with(token); }

  std::string_view text_;
  std::size_t position_ = 0;
  std::vector<std::string_view> open_;
  std::vector<XmlAttribute> attributes_;
  std::string_view name_;
  int depth_ = 0;
  bool is_start_ = false;
  bool pending_end_ = false;  // the current tag was <a/>: its end comes next
  bool root_seen_ = false;
};

// Whether the bytes are valid UTF-8.
bool is_utf8(std::string_view bytes);

}  // namespace codesign::dynamics
