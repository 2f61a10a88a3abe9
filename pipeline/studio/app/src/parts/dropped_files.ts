// The files of a drop or a chosen folder, folders opened, and which of them are photographs.

const photograph = /\.(jpe?g|png|tiff?|exr|heic|heif|avif|webp|dng|cr2|cr3|nef|nrw|arw|orf|rw2|raf|pef|srw|raw)$/i;
const hidden = /^(\.|Thumbs\.db$|desktop\.ini$)/i;

function filesOf(entry: FileSystemFileEntry): Promise<File[]> {
  return new Promise((done) => entry.file((file) => done([file]), () => done([])));
}

async function entriesOf(folder: FileSystemDirectoryEntry): Promise<FileSystemEntry[]> {
  const reader = folder.createReader();
  const all: FileSystemEntry[] = [];
  for (;;) {
    // Chromium answers at most a hundred at a time.
    const some = await new Promise<FileSystemEntry[]>((done) => reader.readEntries(done, () => done([])));
    if (some.length === 0) return all;
    all.push(...some);
  }
}

// Of a capture's folder the photographs alone: beside them lie maps and materials.
function photographsFirst(inside: FileSystemEntry[]): FileSystemEntry[] {
  const photos = inside.filter((entry) => entry.isDirectory && entry.name === 'photos');
  return inside.some((entry) => entry.name === 'capture.toml') && photos.length ? photos : inside;
}

async function walk(entry: FileSystemEntry): Promise<File[]> {
  if (entry.isFile) return filesOf(entry as FileSystemFileEntry);
  const inside = photographsFirst(await entriesOf(entry as FileSystemDirectoryEntry));
  return (await Promise.all(inside.map(walk))).flat();
}

export async function droppedFiles(transfer: DataTransfer): Promise<{ files: File[]; fromFolder: boolean }> {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry()).filter((entry) => entry !== null);
  if (entries.length === 0) return { files: [...transfer.files], fromFolder: false };
  const fromFolder = entries.some((entry) => entry.isDirectory);
  return { files: (await Promise.all(entries.map(walk))).flat(), fromFolder };
}

// The same of a chosen folder, whose files come with their paths.
function withoutMaps(files: File[]): File[] {
  const paths = files.map((file) => file.webkitRelativePath);
  const captures = paths.filter((path) => path.endsWith('/capture.toml')).map((path) => path.slice(0, -'capture.toml'.length));
  const bare = captures.filter((folder) => paths.some((path) => path.startsWith(`${folder}photos/`)));
  return files.filter(({ webkitRelativePath: path }) => !bare.some((folder) => path.startsWith(folder) && !path.startsWith(`${folder}photos/`)));
}

// A folder holds other things too, which are left out without a word for each; files chosen one by one are all sent.
export function photographsAmong(files: File[]): { photographs: File[]; ignored: number } {
  const visible = withoutMaps(files).filter((file) => !hidden.test(file.name));
  const photographs = visible.filter((file) => photograph.test(file.name));
  photographs.sort((a, b) => a.name.localeCompare(b.name, 'en', { numeric: true }));
  return { photographs, ignored: visible.length - photographs.length };
}

export const accepted = 'image/*,.heic,.heif,.avif,.exr,.dng,.cr2,.cr3,.nef,.arw,.orf,.rw2,.raf';
