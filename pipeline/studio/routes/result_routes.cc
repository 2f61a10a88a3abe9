#include "pipeline/studio/routes/result_routes.h"

#include "base/files/files.h"
#include "pipeline/studio/access/token.h"
#include "pipeline/studio/routes/replies.h"
#include "pipeline/studio/runs/results.h"

namespace glint {
namespace {

HttpReply SendZip(const LibraryEntry& entry) {
  HttpReply reply;
  reply.file = ZipOfExport(entry.folder);
  reply.type = "application/zip";
  reply.headers.emplace_back("Content-Disposition",
                             "attachment; filename=\"" + FileNameOf(entry.name) + ".zip\"");
  return reply;
}

}  // namespace

HttpReply RouteResult(const RouteContext& context, const Segments& at, bool* is_report) {
  if (at.size() < 4 || !SameSecret(context.files_secret, at[1])) ThrowNotFound();
  const LibraryEntry entry = context.workspace->Find(at[2]);
  std::string name = at[3];
  for (size_t i = 4; i < at.size(); ++i) name += "/" + at[i];
  if (name == "export.zip") return SendZip(entry);
  const auto files = ResultFiles(entry.folder);
  const auto found = files.find(name);
  if (found == files.end()) ThrowNotFound();
  *is_report = name.ends_with(".html");
  return FileReply(found->second, TypeOfFile(name));
}

std::string AddressOfFiles(const RouteContext& context, const LibraryEntry& entry) {
  return "/files/" + context.files_secret + "/" + entry.id + "/";
}

}  // namespace glint
