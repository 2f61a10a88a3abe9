// The few pictograms, drawn with the colour of the text beside them.
import type { ComponentChildren } from 'preact';

function Icon({ children }: { children: ComponentChildren }) {
  return (
    <svg class="icon" viewBox="0 0 20 20" width="20" height="20" aria-hidden="true" fill="none" stroke="currentColor" stroke-width="1.6" stroke-linecap="round" stroke-linejoin="round">
      {children}
    </svg>
  );
}

export const PlusIcon = () => <Icon><path d="M10 4v12M4 10h12" /></Icon>;
export const SearchIcon = () => <Icon><circle cx="9" cy="9" r="5" /><path d="m13 13 4 4" /></Icon>;
export const TrashIcon = () => <Icon><path d="M4 6h12M8 6V4h4v2M6 6l.7 10h6.6L14 6" /></Icon>;
export const PhoneIcon = () => <Icon><rect x="6" y="2.5" width="8" height="15" rx="1.8" /><path d="M9.2 15h1.6" /></Icon>;
export const FolderIcon = () => <Icon><path d="M2.5 6a1.5 1.5 0 0 1 1.5-1.5h3.5l1.8 2h6.7a1.5 1.5 0 0 1 1.5 1.5v6a1.5 1.5 0 0 1-1.5 1.5H4A1.5 1.5 0 0 1 2.5 14z" /></Icon>;
export const PicturesIcon = () => <Icon><rect x="2.5" y="4" width="15" height="12" rx="1.5" /><circle cx="7" cy="8.2" r="1.3" /><path d="m3 14.5 4.3-3.7 3 2.5 3-2.9 4 3.6" /></Icon>;
export const CameraIcon = () => <Icon><path d="M3 6.5h3L7.5 4.5h5L14 6.5h3v9H3z" /><circle cx="10" cy="10.8" r="2.7" /></Icon>;
export const DownloadIcon = () => <Icon><path d="M10 3v9M6 8.5l4 4 4-4M4 16.5h12" /></Icon>;
export const OutIcon = () => <Icon><path d="M11.5 4H16v4.5M16 4l-7 7M14 11.5V16H4V6h4.5" /></Icon>;
export const CheckIcon = () => <Icon><path d="m4.5 10.5 3.7 3.7 7.3-8" /></Icon>;
export const WarningIcon = () => <Icon><path d="M10 3.5 17.5 16.5h-15zM10 8.5v3.5M10 14.3v.1" /></Icon>;
export const CrossIcon = () => <Icon><path d="m5.5 5.5 9 9M14.5 5.5l-9 9" /></Icon>;
export const FlashIcon = () => <Icon><path d="M11 2.5 5 11.5h4.2L8.5 17.5l6-9h-4.2z" /></Icon>;
export const BackIcon = () => <Icon><path d="M12.5 4.5 7 10l5.5 5.5" /></Icon>;
