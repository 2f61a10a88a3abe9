// Takes photographs by drag and drop, by choosing files, or by choosing a folder.
import type { ComponentChildren } from 'preact';
import { useRef, useState } from 'preact/hooks';
import { announce } from '../announce';
import { texts } from '../texts';
import { accepted, droppedFiles, photographsAmong } from './dropped_files';
import { FolderIcon, PicturesIcon } from './icons';

const t = texts.photographsPage;

interface DropAreaProps {
  onFiles: (files: File[]) => void;
  children?: ComponentChildren; // further buttons
}

export function DropArea({ onFiles, children }: DropAreaProps) {
  const files = useRef<HTMLInputElement>(null);
  const folder = useRef<HTMLInputElement>(null);
  const [over, setOver] = useState(false);
  const [ignored, setIgnored] = useState(0);
  const depth = useRef(0); // enter and leave come for every element inside

  const take = (list: File[], fromFolder: boolean) => {
    const chosen = fromFolder ? photographsAmong(list) : { photographs: list, ignored: 0 };
    setIgnored(chosen.ignored);
    if (chosen.ignored) announce(t.ignored(chosen.ignored));
    onFiles(chosen.photographs);
  };
  const takeInput = (input: HTMLInputElement, fromFolder: boolean) => {
    take([...(input.files ?? [])], fromFolder);
    input.value = ''; // the same file may be chosen again
  };
  const drop = async (event: DragEvent) => {
    event.preventDefault();
    depth.current = 0;
    setOver(false);
    if (!event.dataTransfer) return;
    const dropped = await droppedFiles(event.dataTransfer);
    take(dropped.files, dropped.fromFolder);
  };
  return (
    <div
      class={over ? 'drop over' : 'drop'}
      onDragEnter={(event) => {
        event.preventDefault();
        ++depth.current;
        setOver(true);
      }}
      onDragLeave={() => {
        depth.current = Math.max(0, depth.current - 1);
        if (depth.current === 0) setOver(false);
      }}
      onDragOver={(event) => event.preventDefault()}
      onDrop={drop}
    >
      <p class="drop-title">{over ? t.dropNow : t.drop}</p>
      <p class="quiet">{t.dropHelp}</p>
      <div class="actions centre">
        <button type="button" class="button" onClick={() => files.current?.click()}><PicturesIcon />{t.choose}</button>
        <button type="button" class="button" onClick={() => folder.current?.click()}><FolderIcon />{t.folder}</button>
        {children}
      </div>
      {ignored > 0 && <p class="quiet">{t.ignored(ignored)}</p>}
      <input ref={files} class="file" type="file" multiple accept={accepted} aria-label={t.choose} tabIndex={-1} onChange={(event) => takeInput(event.currentTarget, false)} />
      <input ref={folder} class="file" type="file" multiple {...{ webkitdirectory: true }} aria-label={t.folder} tabIndex={-1} onChange={(event) => takeInput(event.currentTarget, true)} />
    </div>
  );
}
