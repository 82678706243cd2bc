#include "dynamics/xml_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include "errors.hpp"

namespace codesign::dynamics {
namespace {

constexpr std::size_t kMaxDepth = 100;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

bool is_name_start(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == ':' ||
         static_cast<unsigned char>(c) >= 0x80;
}

bool is_name_char(char c) {
  return is_name_start(c) || (c >= '0' && c <= '9') || c == '-' || c == '.';
}

void append_utf8(std::uint32_t code, std::string& out) {
  const auto tail = [&](int shift) { out += static_cast<char>(0x80U | ((code >> shift) & 0x3FU)); };
  if (code < 0x80U) {
    out += static_cast<char>(code);
  } else if (code < 0x800U) {
    out += static_cast<char>(0xC0U | (code >> 6U));
    tail(0);
  } else if (code < 0x10000U) {
    out += static_cast<char>(0xE0U | (code >> 12U));
    tail(6);
    tail(0);
  } else {
    out += static_cast<char>(0xF0U | (code >> 18U));
    tail(12);
    tail(6);
    tail(0);
  }
}

}  // namespace

bool is_utf8(std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size();) {
    const auto lead = static_cast<unsigned char>(bytes[i]);
    const std::size_t length = lead < 0x80   ? 1
                               : lead < 0xC2 ? 0
                               : lead < 0xE0 ? 2
                               : lead < 0xF0 ? 3
                               : lead < 0xF5 ? 4
                                             : 0;
    if (length == 0 || i + length > bytes.size()) return false;
    std::uint32_t code = length == 1 ? lead : lead & (0x7FU >> length);
    for (std::size_t k = 1; k < length; ++k) {
      const auto byte = static_cast<unsigned char>(bytes[i + k]);
      if ((byte & 0xC0U) != 0x80U) return false;
      code = (code << 6U) | (byte & 0x3FU);
    }
    const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
    if (overlong || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) return false;
    i += length;
  }
  return true;
}

XmlReader::XmlReader(std::string_view text) : text_(text) {
  if (const std::size_t nul = text_.find('\0'); nul != std::string_view::npos) {
    position_ = nul;
    fail("a zero byte: not text in UTF-8");
  }
  if (at("\xEF\xBB\xBF")) position_ = 3;  // byte order mark
}

void XmlReader::fail(const std::string& reason) const {
  const auto end = text_.begin() + static_cast<std::ptrdiff_t>(std::min(position_, text_.size()));
  const auto line = 1 + std::count(text_.begin(), end, '\n');
  throw UrdfError("URDF line " + std::to_string(line) + ": " + reason);
}

void XmlReader::skip_past(std::string_view end, const char* what) {
  const std::size_t found = text_.find(end, position_);
  if (found == std::string_view::npos) fail(std::string("unfinished ") + what);
  position_ = found + end.size();
}

void XmlReader::skip_space() {
  while (position_ < text_.size() && is_space(text_[position_])) ++position_;
}

// To the '<' of the next tag or to the end of the text.
void XmlReader::skip_to_tag() {
  for (;;) {
    const std::size_t next = std::min(text_.find('<', position_), text_.size());
    if (open_.empty()) {
      skip_space();
      if (position_ != next) fail("text outside of the root element");
    }
    position_ = next;
    if (at("<!--")) {
      position_ += 4;
      skip_past("-->", "comment");
    } else if (at("<![CDATA[")) {
      skip_past("]]>", "CDATA section");
    } else if (at("<!")) {
      fail("document type declarations are refused");
    } else if (at("<?")) {
      skip_past("?>", "processing instruction");
    } else {
      return;
    }
  }
}

std::string_view XmlReader::read_name() {
  const std::size_t start = position_;
  if (position_ >= text_.size() || !is_name_start(text_[position_])) fail("a name is missing");
  while (position_ < text_.size() && is_name_char(text_[position_])) ++position_;
  return text_.substr(start, position_ - start);
}

std::string XmlReader::decode(std::string_view raw) const {
  std::string out;
  out.reserve(raw.size());
  for (std::size_t i = 0; i < raw.size(); ++i) {
    if (raw[i] != '&') {
      out += is_space(raw[i]) ? ' ' : raw[i];
      continue;
    }
    const std::size_t end = raw.find(';', i);
    if (end == std::string_view::npos) fail("an '&' that starts no entity");
    const std::string_view entity = raw.substr(i + 1, end - i - 1);
    if (entity == "amp") {
      out += '&';
    } else if (entity == "lt") {
      out += '<';
    } else if (entity == "gt") {
      out += '>';
    } else if (entity == "quot") {
      out += '"';
    } else if (entity == "apos") {
      out += '\'';
    } else if (entity.starts_with('#')) {
      const bool hexadecimal = entity.starts_with("#x");
      const std::string_view digits = entity.substr(hexadecimal ? 2 : 1);
      std::uint32_t code = 0;
      const auto [last, error] = std::from_chars(digits.data(), digits.data() + digits.size(), code,
                                                 hexadecimal ? 16 : 10);
      const bool valid = error == std::errc{} && last == digits.data() + digits.size() &&
                         code >= 0x20 && code <= 0x10FFFF && !(code >= 0xD800 && code <= 0xDFFF);
      if (!valid) fail("a character reference that is no character");
      append_utf8(code, out);
    } else {
      fail("unknown entity &" + std::string(entity.substr(0, 40)) + ";");
    }
    i = end;
  }
  return out;
}

void XmlReader::read_attributes() {
  for (;;) {
    const std::size_t before = position_;
    skip_space();
    if (position_ >= text_.size())
      fail("the text ends inside the tag <" + std::string(name_) + ">");
    if (text_[position_] == '>' || text_[position_] == '/') return;
    if (position_ == before) fail("a space is missing in the tag <" + std::string(name_) + ">");
    const std::string_view name = read_name();
    skip_space();
    if (!at("=")) fail("attribute " + std::string(name) + " has no value");
    ++position_;
    skip_space();
    if (!at("\"") && !at("'"))
      fail("the value of attribute " + std::string(name) + " is not quoted");
    const char quote = text_[position_++];
    const std::size_t end = text_.find(quote, position_);
    if (end == std::string_view::npos) {
      fail("the value of attribute " + std::string(name) + " does not end");
    }
    const std::string_view raw = text_.substr(position_, end - position_);
    if (raw.find('<') != std::string_view::npos) {
      fail("a '<' in the value of attribute " + std::string(name));
    }
    for (const XmlAttribute& other : attributes_) {
      if (other.name == name) fail("attribute " + std::string(name) + " is given twice");
    }
    attributes_.push_back({name, decode(raw)});
    position_ = end + 1;
  }
}

bool XmlReader::next() {
  if (pending_end_) {
    pending_end_ = false;
    is_start_ = false;
    open_.pop_back();
    return true;
  }
  skip_to_tag();
  if (position_ >= text_.size()) {
    if (!open_.empty()) fail("the text ends inside <" + std::string(open_.back()) + ">");
    if (!root_seen_) fail("no element");
    return false;
  }
  ++position_;
  is_start_ = !at("/");
  attributes_.clear();
  if (!is_start_) {
    ++position_;
    name_ = read_name();
    skip_space();
    if (open_.empty() || open_.back() != name_) {
      fail("</" + std::string(name_) + "> closes " +
           (open_.empty() ? "nothing" : "<" + std::string(open_.back()) + ">"));
    }
    depth_ = static_cast<int>(open_.size());
    open_.pop_back();
  } else {
    if (open_.empty() && root_seen_) fail("a second root element");
    root_seen_ = true;
    name_ = read_name();
    read_attributes();
    if (open_.size() >= kMaxDepth) fail("elements nested more than 100 deep");
    open_.push_back(name_);
    depth_ = static_cast<int>(open_.size());
    pending_end_ = at("/");
    if (pending_end_) ++position_;
  }
  if (!at(">")) fail("the tag <" + std::string(name_) + "> does not end");
  ++position_;
  return true;
}

}  // namespace codesign::dynamics
