"""Verification: figures with their sources, recomputed by the engine on request."""

from rollnip.verification.case import VerificationCase, VerificationResult, verify
from rollnip.verification.registry import all_cases, cases_about
from rollnip.verification.report import document, figure_text, markdown, share_text, summary

__all__ = [
    "VerificationCase",
    "VerificationResult",
    "all_cases",
    "cases_about",
    "document",
    "figure_text",
    "markdown",
    "share_text",
    "summary",
    "verify",
]
