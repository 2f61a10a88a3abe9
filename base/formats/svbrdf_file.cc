#include "base/formats/svbrdf_file.h"

#include "base/formats/svbrdf_rows.h"

namespace glint {

void WriteSvbrdf(const std::filesystem::path& file, const SvbrdfMaps& maps,
                 const ReflectanceConvention& convention) {
  SvbrdfWriter writer(file, maps.width, maps.height, convention);
  writer.Write(maps);
  writer.Close();
}

SvbrdfMaps ReadSvbrdf(const std::filesystem::path& file, ReflectanceConvention* convention) {
  SvbrdfReader reader(file, convention);
  return reader.Read(0, reader.height());
}

}  // namespace glint
