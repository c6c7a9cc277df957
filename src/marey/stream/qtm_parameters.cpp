#include "marey/stream/qtm_parameters.h"

#include <array>
#include <iterator>

#include <fmt/format.h>

#include "marey/files/text_safety.h"
#include "marey/stream/qtm_packets.h"

namespace marey::stream {
namespace {

constexpr double kMmOfM = 1000;

std::string general_xml(const RecordingHeader& header, int minor) {
  std::string xml = fmt::format(
      "<General><Frequency>{:.6g}</Frequency><Capture_Time>0</Capture_Time>"
      "<Start_On_External_Trigger>False</Start_On_External_Trigger>",
      header.rate_hz);
  if (minor >= 15) {
    xml +=
        "<Start_On_Trigger_NO>False</Start_On_Trigger_NO><Start_On_Trigger_NC>False</Start_On_Trigger_NC>"
        "<Start_On_Trigger_Software>False</Start_On_Trigger_Software>";
  }
  return xml + R"(<EulerAngles First="Roll" Second="Pitch" Third="Yaw"/></General>)";
}

std::string points_xml(const ChannelLayout& channel_layout) {
  std::string xml = fmt::format("<The_3D><AxisUpwards>+Z</AxisUpwards><CalibrationTime></CalibrationTime><Labels>{}</Labels>",
                                channel_layout.labels().size());
  for (const std::string& label : channel_layout.labels()) {
    fmt::format_to(std::back_inserter(xml),
                   "<Label><Name>{}</Name><RGBColor>65280</RGBColor><Trajectory_Type>Measured</Trajectory_Type></Label>",
                   xml_escaped(label));
  }
  return xml + "<Bones/></The_3D>";
}

std::string bodies_xml_to_20(const ChannelLayout& channel_layout) {
  std::string xml = fmt::format("<The_6D><Bodies>{}</Bodies>", channel_layout.bodies().size());
  for (const Body& body : channel_layout.bodies()) {
    fmt::format_to(std::back_inserter(xml), "<Body><Name>{}</Name><RGBColor>65280</RGBColor>", xml_escaped(body.label));
    for (const BodyMarker& marker : body.markers) {
      const Vector<3> at = kMmOfM * marker.position;
      fmt::format_to(std::back_inserter(xml), "<Point><X>{:.6f}</X><Y>{:.6f}</Y><Z>{:.6f}</Z></Point>", at.x(), at.y(), at.z());
    }
    xml += "</Body>";
  }
  return xml + "<Euler><First>Roll</First><Second>Pitch</Second><Third>Yaw</Third></Euler></The_6D>";
}

std::string bodies_xml_from_21(const ChannelLayout& channel_layout) {
  std::string xml = "<The_6D>";
  for (const Body& body : channel_layout.bodies()) {
    auto out = std::back_inserter(xml);
    fmt::format_to(
        out,
        R"(<Body><Name>{}</Name><Enabled>true</Enabled><Color R="0" G="255" B="0"/><MaximumResidual>10.0</MaximumResidual>)"
        "<MinimumMarkersInBody>3</MinimumMarkersInBody><BoneLengthTolerance>5.0</BoneLengthTolerance>"
        R"(<Filter Preset="No filter"/><Points>)",
        xml_escaped(body.label));
    for (const BodyMarker& marker : body.markers) {
      const Vector<3> at = kMmOfM * marker.position;
      fmt::format_to(out, R"(<Point X="{:.6f}" Y="{:.6f}" Z="{:.6f}" Virtual="0" PhysicalId="0" Name="{}"/>)", at.x(), at.y(),
                     at.z(), xml_escaped(marker.label));
    }
    xml +=
        R"(</Points><Data_origin X="0.0" Y="0.0" Z="0.0" Relative_body="0">0</Data_origin><Data_orientation )"
        R"(R11="1.0" R12="0.0" R13="0.0" R21="0.0" R22="1.0" R23="0.0" R31="0.0" R32="0.0" R33="1.0" Relative_body="0">0</Data_orientation></Body>)";
  }
  return xml + "</The_6D>";
}

/// A segment with those that hang on it. Depth is bounded by the segments' number.
void append_segment(std::string& xml, const Skeleton& skeleton, const Body& segment) {
  const Vector<3> at = kMmOfM * segment.offset;
  const std::string transform = fmt::format(
      R"(<Position X="{:.6f}" Y="{:.6f}" Z="{:.6f}"/><Rotation X="0.0" Y="0.0" Z="0.0" W="1.0"/>)", at.x(), at.y(), at.z());
  fmt::format_to(std::back_inserter(xml),
                 R"(<Segment Name="{}" ID="{}"><Transform>{}</Transform><DefaultTransform>{}</DefaultTransform>)",
                 xml_escaped(segment.label), number(segment.id), transform, transform);
  for (const Body& child : skeleton.segments) {
    if (child.parent == segment.id && child.id != segment.id) append_segment(xml, skeleton, child);
  }
  xml += "</Segment>";
}

std::string skeletons_xml(const ChannelLayout& channel_layout) {
  std::string xml = "<Skeletons>";
  for (const Skeleton& skeleton : channel_layout.skeletons()) {
    xml += fmt::format(R"(<Skeleton Name="{}"><Scale>100</Scale><Segments>)", xml_escaped(skeleton.name));
    for (const Body& segment : skeleton.segments) {
      if (!segment.parent) append_segment(xml, skeleton, segment);
    }
    xml += "</Segments></Skeleton>";
  }
  return xml + "</Skeletons>";
}

}  // namespace

std::string qtm_parameters_xml(const RecordingHeader& header, const ChannelLayout& channel_layout, const QtmSettings& required,
                               int minor) {
  std::string xml = fmt::format("<QTM_Parameters_Ver_1.{}>", minor);
  if (required.general) xml += general_xml(header, minor);
  if (required.points) xml += points_xml(channel_layout);
  if (required.bodies) xml += minor >= 21 ? bodies_xml_from_21(channel_layout) : bodies_xml_to_20(channel_layout);
  if (required.skeletons && minor >= 21) xml += skeletons_xml(channel_layout);
  return xml + fmt::format("</QTM_Parameters_Ver_1.{}>", minor);
}

}  // namespace marey::stream
