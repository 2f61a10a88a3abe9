// Something that went wrong or must be known, with what to do about it.
import type { ComponentChildren } from 'preact';
import type { Failure } from '../api';
import { texts } from '../texts';
import { CheckIcon, WarningIcon } from './icons';

interface NoticeProps {
  tone?: 'error' | 'warning' | 'good' | 'plain';
  title: ComponentChildren;
  remedy?: ComponentChildren;
  urgent?: boolean; // read out at once
  children?: ComponentChildren;
}

export function Notice({ tone = 'plain', title, remedy, urgent, children }: NoticeProps) {
  return (
    <div class={`notice ${tone}`} role={urgent ? 'alert' : undefined}>
      {tone === 'good' ? <CheckIcon /> : tone === 'plain' ? null : <WarningIcon />}
      <div>
        <p class="notice-title">{title}</p>
        {remedy && (
          <p>
            <b>{texts.errors.remedy}</b> {remedy}
          </p>
        )}
        {children}
      </div>
    </div>
  );
}

export function FailureNotice({ failure, retry }: { failure: Failure; retry?: () => void }) {
  return (
    <Notice tone="error" title={failure.message} remedy={failure.remedy} urgent>
      {retry && (
        <button type="button" class="button small" onClick={retry}>
          {texts.retry}
        </button>
      )}
    </Notice>
  );
}
