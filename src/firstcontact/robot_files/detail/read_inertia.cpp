#include <string>

#include <Eigen/Core>

#include <firstcontact/robot_files/detail/read_link.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact::detail {
namespace {

Eigen::Matrix3d moments(const XmlElement& element, const XmlReader& xml) {
  const auto moment = [&](const char* name) {
    return xml.optional_number(element, name).value_or(0.0);
  };
  // Read before Eigen's list begins, as no exception may leave that.
  const double xx = moment("ixx");
  const double xy = moment("ixy");
  const double xz = moment("ixz");
  const double yy = moment("iyy");
  const double yz = moment("iyz");
  const double zz = moment("izz");
  Eigen::Matrix3d about_C;
  about_C << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return about_C;
}

LinkInertia read(const XmlElement& inertial, const UrdfContext& context) {
  const XmlReader& xml = context.xml;
  const Pose X_LC = context.origin(inertial);
  LinkInertia inertia{.p_LC = X_LC.position};
  if (const XmlElement* mass = xml.child(inertial, "mass")) {
    context.names.check(*mass, urdf_names().mass);
    inertia.mass = xml.number(*mass, "value");
  }
  if (const XmlElement* element = xml.child(inertial, "inertia")) {
    context.names.check(*element, urdf_names().inertia);
    const Eigen::Matrix3d R_LC = X_LC.rotation.toRotationMatrix();
    inertia.about_C_L = R_LC * moments(*element, xml) * R_LC.transpose();
  }
  return inertia;
}

}  // namespace

LinkInertia read_inertia(const XmlElement& link, const XmlElement& inertial,
                         const UrdfContext& context) {
  // A log apart from that of the file: here nothing is an error before forces move the link.
  ReadingLog log(context.log.path(), "URDF");
  const XmlNameCheck names(context.xml, log, urdf_names().telling);
  const UrdfContext apart{context.xml, names, log, context.source, context.options};
  LinkInertia inertia;
  try {
    names.check(inertial, urdf_names().inertial);
    inertia = read(inertial, apart);
    const XmlElement* second = inertial.NextSiblingElement("inertial");
    if (second != nullptr) {
      context.xml.fail(*second, "a second one inside " + shown(link) + "; keep one");
    }
    const FileReport report = log.finish();
    if (!report.warnings.empty()) {
      inertia.defect = report.warnings.front();
    }
    for (const LeftOut& entry : report.left_out) {
      context.log.leave_out(entry.name, entry.reason);
    }
  } catch (const ParseError& error) {
    inertia.defect = error.what();
  }
  if (!inertia.defect.empty()) {
    context.log.leave_out("<inertial>", "nothing moves by forces; " + inertia.defect);
  }
  return inertia;
}

}  // namespace firstcontact::detail
