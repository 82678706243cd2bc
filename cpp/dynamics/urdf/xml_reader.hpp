#pragma once

#include <string_view>
#include <vector>

namespace codesign::dynamics {

// An attribute of an element, as views of the text.
struct XmlAttribute {
  std::string_view name, value;
};

// Hears of the elements of an XML text, in its order. An UrdfError that it throws gets the line;
// but for the root element it hears of the rest, too, so that all faults of a text are named.
class XmlListener {
 public:
  virtual ~XmlListener() = default;
  virtual void start(std::string_view name, const std::vector<XmlAttribute>& attributes) = 0;
  virtual void end() = 0;
};

// What the bytes of a text mean: UTF-8, or what byte order mark and XML declaration say (UTF-8 if
// they say nothing).
enum class XmlEncoding { kUtf8, kDeclared };

// Reads an XML text with expat. White space may stand before it. A document type declaration is
// refused, so no entity beyond the five of XML exists and none can expand; nesting is bounded.
// Throws UrdfError naming the line.
void read_xml(std::string_view text, XmlEncoding encoding, XmlListener& listener);

}  // namespace codesign::dynamics
