// What a run has made: the page to relight it, figures with their meaning, maps, tile, before and after, files.
import { useState } from 'preact/hooks';
import { announce } from '../announce';
import { api, type Failure, type Figure, type ResultMap } from '../api';
import { mapName } from '../format';
import { BeforeAfter } from '../parts/before_after';
import { DownloadIcon, FolderIcon, OutIcon } from '../parts/icons';
import { FailureNotice, Notice } from '../parts/notice';
import { TilePreview } from '../parts/tile_preview';
import { links } from '../router';
import { texts } from '../texts';
import type { StepProps } from './capture_page';

const t = texts.result;

function Figures({ figures }: { figures: Figure[] }) {
  return (
    <section class="panel" aria-labelledby="figures-title">
      <h2 id="figures-title">{t.figures}</h2>
      <dl class="figures">
        {figures.map((figure) => (
          <div key={figure.name}>
            <dt class="sentence">{figure.name}</dt>
            <dd class="figure-value">{figure.value}</dd>
            <dd class="quiet sentence">{figure.meaning}</dd>
          </div>
        ))}
      </dl>
    </section>
  );
}

function Maps({ maps }: { maps: ResultMap[] }) {
  return (
    <section class="panel" aria-labelledby="maps-title">
      <h2 id="maps-title">{t.maps}</h2>
      <ul class="maps">
        {maps.map((map) => (
          <li key={map.name}>
            <img src={map.url} alt="" loading="lazy" decoding="async" />
            <div class="map-head">
              <h3>{mapName(map.name)}</h3>
              <a class="icon-button" href={map.url} download aria-label={t.download(mapName(map.name))} title={t.download(mapName(map.name))}><DownloadIcon /></a>
            </div>
            <p class="quiet sentence">{map.meaning}</p>
          </li>
        ))}
      </ul>
    </section>
  );
}

export function ResultStep({ capture }: StepProps) {
  const [failure, setFailure] = useState<Failure | null>(null);
  const { result } = capture;
  if (!result) {
    return (
      <div class="empty small">
        <h2>{t.none}</h2>
        <p>{t.noneText}</p>
        <a class="button primary" href={links.step(capture.id, 'run')}>{t.goRun}</a>
      </div>
    );
  }
  const openFolder = async () => {
    try {
      await api.openFolder(capture.id);
      setFailure(null);
      announce(t.opened);
    } catch (error) {
      setFailure(error as Failure);
    }
  };
  return (
    <div class="stack">
      {capture.status === 'out of date' && <Notice tone="warning" title={texts.run.outOfDate} />}
      {result.quick && (
        <Notice title={t.quick}>
          <a class="button small primary" href={links.step(capture.id, 'run')}>{t.goRun}</a>
        </Notice>
      )}
      <section class="panel" aria-labelledby="page-title">
        <header>
          <h2 id="page-title">{t.page}</h2>
          <a class="with-icon" href={result.page} target="_blank" rel="noopener"><OutIcon />{t.openPage}</a>
        </header>
        <p class="quiet">{t.pageText}</p>
        <iframe class="report" src={result.page} title={t.pageFrame} sandbox="allow-scripts allow-downloads allow-popups" />
      </section>
      {result.figures.length > 0 && <Figures figures={result.figures} />}
      {result.maps.length > 0 && <Maps maps={result.maps} />}
      <div class="halves">
        {result.tile && <TilePreview url={result.tile} />}
        {result.previous && <BeforeAfter before={result.previous.maps} after={result.maps} />}
      </div>
      <section class="panel" aria-labelledby="files-title">
        <h2 id="files-title">{t.downloads}</h2>
        {failure && <FailureNotice failure={failure} />}
        <ul class="files">
          {result.zip && <li><a class="button primary" href={result.zip} download><DownloadIcon />{t.zip}</a> <span class="quiet">{t.zipText}</span></li>}
          {result.glb && <li><a class="button" href={result.glb} download><DownloadIcon />{t.glb}</a> <span class="quiet">{t.glbText}</span></li>}
          <li><button type="button" class="button" onClick={openFolder}><FolderIcon />{t.openFolder}</button> <span class="quiet">{t.openFolderText}</span></li>
        </ul>
      </section>
    </div>
  );
}
